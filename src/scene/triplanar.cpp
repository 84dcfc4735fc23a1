// Each side is a look-up of the whole material; what they say is blended.
#include "scene/triplanar.h"

namespace brickfield {

namespace {

struct Side {
  glm::vec3 right, up; ///< in the picture that the texture is
};

Side sideOf(int axis, glm::vec3 normal) {
  const float sign = normal[axis] < 0 ? -1.0f : 1.0f;
  if (axis == 0) return {{0, 0, -sign}, {0, 1, 0}};
  if (axis == 1) return {{1, 0, 0}, {0, 0, -sign}};
  return {{sign, 0, 0}, {0, 1, 0}};
}

glm::vec2 uvOf(const Side& side, glm::vec3 offset, float metres) {
  return glm::vec2(glm::dot(offset, side.right), -glm::dot(offset, side.up)) / metres;
}

glm::vec3 bentNormal(const Side& side, glm::vec3 normal, glm::vec3 mapped) {
  const glm::vec3 along = side.right - normal * glm::dot(normal, side.right);
  const float length = glm::length(along);
  if (!(length > 0)) return normal;
  const glm::vec3 tangent = along / length;
  return glm::normalize(mapped.x * tangent + mapped.y * glm::cross(normal, tangent) + mapped.z * normal);
}

} // namespace

TriplanarSample sampleTriplanar(const TextureSampler& sampler, const Material& material, const TriplanarPoint& at,
                                float metres) {
  const glm::vec3 squared = at.normalObject * at.normalObject;
  const glm::vec3 weights = squared * squared / glm::dot(squared, squared);
  TriplanarSample sum;
  sum.material = {glm::vec4(0), 0, 0, 0, glm::vec3(0), {0, 0, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const Side side = sideOf(axis, at.normalObject);
    MaterialPoint point;
    point.uv.fill(uvOf(side, at.pointObject, metres));
    point.uvPerFootprint.fill({uvOf(side, at.footprintObject[0], metres), uvOf(side, at.footprintObject[1], metres)});
    const MaterialSample sample = sampler.sampleMaterial(material, point);
    sum.material.baseColor += weights[axis] * sample.baseColor;
    sum.material.metallic += weights[axis] * sample.metallic;
    sum.material.roughness += weights[axis] * sample.roughness;
    sum.material.occlusion += weights[axis] * sample.occlusion;
    sum.material.emission += weights[axis] * sample.emission;
    sum.normalObject += weights[axis] * bentNormal(side, at.normalObject, sample.normalTangent);
  }
  const float length = glm::length(sum.normalObject);
  sum.normalObject = length > 0 ? sum.normalObject / length : at.normalObject;
  return sum;
}

} // namespace brickfield
