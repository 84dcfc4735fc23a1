// What a bake is given. Like bake_cache.cpp it needs no Embree: builds without the baker read its cache with both.
#include "bakers/bake.h"

#include <algorithm>

namespace brickfield {

namespace {

// Legs that stand a little lower than a floor and skirtings a little beyond a wall are no other side.
constexpr double kBorderShare = 0.02;

/// Where a flat mesh lies: a point of it and a unit normal; zero where it is not flat, or not double-sided all over.
struct MeshPlane {
  glm::dvec3 point{0.0}, normal{0.0};
};

MeshPlane planeOf(const BakeInput& input) {
  double area = 0;
  glm::dvec3 areaVector(0.0), areaCentroid(0.0);
  for (std::size_t p = 0; p < input.primitives.size(); ++p) {
    if (!materialOf(*input.scene, *input.primitives[p]).doubleSided) return {};
    const std::vector<std::uint32_t>& indices = input.primitives[p]->indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      std::array<glm::dvec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        if (indices[i + k] >= input.positionsObject[p].size()) return {};
        corners[k] = input.positionsObject[p][indices[i + k]];
      }
      const glm::dvec3 vector = 0.5 * glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      area += glm::length(vector);
      areaVector += vector;
      areaCentroid += glm::length(vector) * (corners[0] + corners[1] + corners[2]) / 3.0;
    }
  }
  if (!(glm::length(areaVector) > kFlatShare * area)) return {}; // zeros and what is not a number too
  return {areaCentroid / area, glm::normalize(areaVector)};
}

/// Heights of the vertices of a pose over a plane of world space.
class HeightRange {
public:
  HeightRange(glm::dvec3 pointWorld, glm::dvec3 normalWorld) : point_(pointWorld), normal_(normalWorld) {}

  void add(const Scene& scene, const PosedInstance& instance) {
    const glm::dmat4 worldFromObject(instance.worldFromObject);
    const glm::dvec3 normal = glm::transpose(glm::dmat3(worldFromObject)) * normal_;
    const double height = glm::dot(glm::dvec3(worldFromObject[3]) - point_, normal_);
    for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
      if (isDeformed(primitive, instance))
        addHeights(deformPrimitive(primitive, instance).positions, normal, height);
      else
        addHeights(primitive.positions, normal, height);
    }
  }
  /// 1 where all lies before the plane, but for a border's share; -1 where behind; 0 where on both sides.
  double side() const {
    if (most_ > 0 && -least_ <= kBorderShare * most_) return 1;
    return least_ < 0 && most_ <= kBorderShare * -least_ ? -1 : 0;
  }

private:
  void addHeights(const std::vector<glm::vec3>& positions, glm::dvec3 normal, double height) {
    for (const glm::vec3 position : positions) {
      const double value = glm::dot(glm::dvec3(position), normal) + height;
      least_ = std::min(least_, value), most_ = std::max(most_, value);
    }
  }

  glm::dvec3 point_, normal_;
  double least_ = 0, most_ = 0; ///< metres, the plane itself included
};

} // namespace

BakeInput bakeInputOf(const Scene& scene, const PosedInstance& instance) {
  const Mesh& mesh = scene.meshes.at(static_cast<std::size_t>(instance.mesh));
  BakeInput input;
  input.label = nodeLabel(scene, instance.node);
  input.scene = &scene;
  for (const Primitive& primitive : mesh.primitives) {
    input.primitives.push_back(&primitive);
    input.positionsObject.push_back(isDeformed(primitive, instance) ? deformPrimitive(primitive, instance).positions
                                                                    : primitive.positions);
  }
  return input;
}

BakeInput bakeInputOf(const Scene& scene, const PosedInstance& instance, const Pose& pose) {
  BakeInput input = bakeInputOf(scene, instance);
  const MeshPlane plane = planeOf(input);
  if (plane.normal == glm::dvec3(0.0)) return input;
  const glm::dmat4 worldFromObject(instance.worldFromObject);
  // Of the inverse transpose and the cofactor matrix only the latter exists always; the sign of what it makes does not
  // matter here, as long as it is carried back by the same one.
  const glm::dvec3 normalWorld = glm::dmat3(normalMatrix(instance.worldFromObject)) * plane.normal;
  if (!(glm::length(normalWorld) > 0)) return input;
  HeightRange heights(glm::dvec3(worldFromObject * glm::dvec4(plane.point, 1.0)), glm::normalize(normalWorld));
  for (const PosedInstance& other : pose.instances) heights.add(scene, other);
  // In object space the same side: where the normal leads, or for a mirrored transform away from there.
  const double mirrored = glm::determinant(glm::dmat3(worldFromObject)) < 0 ? -1 : 1;
  input.seenFromObject = glm::vec3(heights.side() * mirrored * plane.normal);
  return input;
}

} // namespace brickfield
