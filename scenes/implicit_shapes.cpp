// Implicit surfaces to triangles by a dual method (Gibson 1998, surface nets), then Newton steps onto the surface.
// The mesh is closed; it is manifold where no cell is crossed by two sheets, which the caller's resolution decides.
#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

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
      shape_.uvs.push_back({0.5f + std::atan2(p.x, p.z) / glm::two_pi<float>(), 0.5f - 0.5f * p.y / halfSide_});
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

/// Maximum whose edge is rounded over about k metres (polynomial smooth maximum, Quilez).
float smoothMax(float a, float b, float k) {
  float overlap = std::max(k - std::abs(a - b), 0.0f) / k;
  return std::max(a, b) + 0.25f * overlap * overlap * k;
}

} // namespace

Shape implicitShape(float halfSide, int cells, const std::function<float(glm::vec3)>& field) {
  return DualMesher(halfSide, cells, field).mesh();
}

Shape gyroidBallShape(float radius, float waves, float wall, int cells) {
  const float frequency = glm::pi<float>() * waves / radius;
  auto field = [=](glm::vec3 p) {
    glm::vec3 s = glm::sin(frequency * p);
    glm::vec3 c = glm::cos(frequency * p);
    float lattice = s.x * c.y + s.y * c.z + s.z * c.x;
    // The gyroid's slope at its zero set is between 1.2 and 1.7 times the frequency.
    float sheet = std::abs(lattice) / (1.45f * frequency) - wall;
    return smoothMax(glm::length(p) - radius, sheet, 0.6f * wall);
  };
  return implicitShape(1.06f * radius, cells, field);
}

} // namespace brickfield::scenes
