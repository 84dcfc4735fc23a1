// Implicit surfaces to triangles by a dual method (Gibson 1998, surface nets), then Newton steps onto the surface.
// The mesh is closed and manifold: grids that would give anything else are passed over.
#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "core/error.h"
#include "scenes/shapes.h"

namespace brickfield::scenes {
namespace {

class DualMesher {
public:
  DualMesher(float halfSide, int cells, const std::function<float(glm::vec3)>& field)
      : halfSide_(halfSide), cells_(cells), field_(field), spacing_(2 * halfSide / static_cast<float>(cells)) {}

  Shape mesh() {
    sampleField();
    placeVertices();
    joinQuads();
    settleVertices();
    return std::move(shape_);
  }

private:
  std::size_t sampleIndex(glm::ivec3 p) const {
    auto side = static_cast<std::size_t>(cells_ + 1);
    return (static_cast<std::size_t>(p.z) * side + static_cast<std::size_t>(p.y)) * side +
           static_cast<std::size_t>(p.x);
  }
  glm::vec3 samplePoint(glm::ivec3 p) const { return spacing_ * glm::vec3(p) - halfSide_; }
  bool isInside(glm::ivec3 p) const { return samples_[sampleIndex(p)] < 0; }

  template <typename Visit>
  void forEach(int first, int last, Visit visit) const {
    for (int z = first; z <= last; ++z)
      for (int y = first; y <= last; ++y)
        for (int x = first; x <= last; ++x) visit(glm::ivec3(x, y, z));
  }

  void sampleField() {
    samples_.resize(sampleIndex(glm::ivec3(cells_)) + 1);
    forEach(0, cells_, [&](glm::ivec3 p) { samples_[sampleIndex(p)] = field_(samplePoint(p)); });
  }

  /// In every crossed cell the mean of the crossings of its edges.
  void placeVertices() {
    vertexOfCell_.assign(samples_.size(), 0);
    forEach(0, cells_ - 1, [&](glm::ivec3 cell) {
      glm::vec3 sum(0);
      int crossings = 0;
      for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
          glm::ivec3 from = cell;
          from[(axis + 1) % 3] += corner & 1;
          from[(axis + 2) % 3] += corner >> 1;
          glm::ivec3 to = from;
          to[axis] += 1;
          float a = samples_[sampleIndex(from)];
          float b = samples_[sampleIndex(to)];
          if ((a < 0) == (b < 0)) continue;
          sum += glm::mix(samplePoint(from), samplePoint(to), a / (a - b));
          ++crossings;
        }
      }
      if (crossings == 0) return;
      vertexOfCell_[sampleIndex(cell)] = static_cast<std::uint32_t>(shape_.positions.size());
      shape_.positions.push_back(sum / static_cast<float>(crossings));
    });
  }

  /// Around every crossed edge the four cells that share it.
  void joinQuads() {
    forEach(1, cells_ - 1, [&](glm::ivec3 from) {
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 to = from;
        to[axis] += 1;
        if (isInside(from) == isInside(to)) continue;
        glm::ivec3 stepU(0), stepV(0);
        stepU[(axis + 1) % 3] = 1;
        stepV[(axis + 2) % 3] = 1;
        std::uint32_t a = vertexOfCell_[sampleIndex(from - stepU - stepV)];
        std::uint32_t b = vertexOfCell_[sampleIndex(from - stepV)];
        std::uint32_t c = vertexOfCell_[sampleIndex(from)];
        std::uint32_t d = vertexOfCell_[sampleIndex(from - stepU)];
        if (!isInside(from)) std::swap(b, d);
        addQuad(a, b, c, d);
      }
    });
  }

  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::vector<glm::vec3>& p = shape_.positions;
    // The shorter diagonal makes the better triangles.
    if (glm::distance(p[a], p[c]) <= glm::distance(p[b], p[d])) {
      shape_.indices.insert(shape_.indices.end(), {a, b, c, a, c, d});
    } else {
      shape_.indices.insert(shape_.indices.end(), {b, c, d, b, d, a});
    }
  }

  glm::vec3 gradient(glm::vec3 p) const {
    const float step = 0.05f * spacing_;
    glm::vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 offset(0);
      offset[axis] = step;
      result[axis] = (field_(p + offset) - field_(p - offset)) / (2 * step);
    }
    return result;
  }

  void settleVertices() {
    for (glm::vec3& p : shape_.positions) {
      for (int iteration = 0; iteration < 4; ++iteration) {
        glm::vec3 slope = gradient(p);
        glm::vec3 move = -field_(p) / std::max(glm::dot(slope, slope), 1e-4f) * slope;
        float length = glm::length(move);
        // Never farther than a quarter of a cell at once: neighbours keep their order.
        p += length > 0.25f * spacing_ ? move * (0.25f * spacing_ / length) : move;
      }
      shape_.normals.push_back(glm::normalize(gradient(p)));
    }
  }

  float halfSide_;
  int cells_;
  const std::function<float(glm::vec3)>& field_;
  float spacing_;
  std::vector<float> samples_;
  std::vector<std::uint32_t> vertexOfCell_;
  Shape shape_;
};

/// Whether no directed edge is used twice.
bool hasManifoldEdges(const Shape& shape) {
  std::vector<std::uint64_t> edges;
  edges.reserve(shape.indices.size());
  for (std::size_t i = 0; i < shape.indices.size(); ++i) {
    std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    edges.push_back((static_cast<std::uint64_t>(shape.indices[i]) << 32) | shape.indices[next]);
  }
  std::sort(edges.begin(), edges.end());
  return std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

/// Maximum whose edge is rounded over about k metres (polynomial smooth maximum, Quilez).
float smoothMax(float a, float b, float k) {
  float overlap = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::max(a, b) + 0.25f * overlap * overlap * k;
}

} // namespace

Shape implicitShape(float halfSide, int cells, const std::function<float(glm::vec3)>& field) {
  // Where the surface is a saddle, the grid may hit it so that a face of a cell has its signs crosswise, and four
  // triangles share an edge. Another grid misses it.
  constexpr int kAttempts = 16;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Shape shape = DualMesher(halfSide, cells + attempt, field).mesh();
    if (hasManifoldEdges(shape)) return shape;
  }
  throw Failure("an implicit surface has no manifold mesh at this resolution");
}

Shape porousBallShape(float radius, float thickness, int cells) {
  // Axes through the corners (six) and the faces (ten) of an icosahedron; the golden ratio places both. Corner axes lie
  // 37.4° from the nearest face axes, face axes 41.8° from each other: holes of 18.5° and 10.5° leave bars of 8° or
  // more.
  constexpr float kGolden = 1.6180340f;
  struct Hole {
    glm::vec3 axis;
    float slope; ///< tangent of the angle
  };
  std::vector<Hole> holes;
  const float wide = std::tan(glm::radians(18.5f));
  const float narrow = std::tan(glm::radians(10.5f));
  for (int axis = 0; axis < 3; ++axis) {
    for (float side : {-1.0f, 1.0f}) {
      glm::vec3 corner(0), face(0);
      corner[axis] = 1, corner[(axis + 1) % 3] = side * kGolden;
      face[(axis + 1) % 3] = 1 / kGolden, face[axis] = side * kGolden;
      holes.push_back({glm::normalize(corner), wide});
      holes.push_back({glm::normalize(face), narrow});
    }
  }
  for (int i = 0; i < 4; ++i) holes.push_back({glm::normalize(glm::vec3(1, i & 1 ? 1 : -1, i & 2 ? 1 : -1)), narrow});

  const float middleRadius = radius - 0.5f * thickness;
  auto field = [=](glm::vec3 p) {
    float shell = std::abs(glm::length(p) - middleRadius) - 0.5f * thickness;
    float inHole = -radius;
    for (const Hole& hole : holes) {
      float along = glm::dot(p, hole.axis);
      float across = glm::length(p - along * hole.axis);
      // Distance within the cone, about: exact would need the cosine, which is near 1.
      inHole = std::max(inHole, hole.slope * std::abs(along) - across);
    }
    return smoothMax(shell, inHole, 0.6f * thickness);
  };
  // Two cells of room on every side.
  return implicitShape(radius * static_cast<float>(cells) / static_cast<float>(cells - 4), cells, field);
}

} // namespace brickfield::scenes
