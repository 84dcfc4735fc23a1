// Operations on meshes under construction. Everything is in a fixed order, so that the same call gives the same bytes.
#include "scenes/shape.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace brickfield::scenes {
namespace {

using PositionKey = std::array<std::uint32_t, 3>;

PositionKey positionKey(glm::vec3 p) {
  p += 0.0f; // -0 becomes 0
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y), std::bit_cast<std::uint32_t>(p.z)};
}

/// For each vertex the number of its position among the distinct ones.
std::vector<std::uint32_t> weldedIndices(const std::vector<glm::vec3>& positions) {
  std::map<PositionKey, std::uint32_t> numbers;
  std::vector<std::uint32_t> welded;
  welded.reserve(positions.size());
  for (glm::vec3 p : positions) {
    welded.push_back(numbers.try_emplace(positionKey(p), static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  return welded;
}

/// Twice the area times the normal.
glm::vec3 faceVector(const Shape& shape, std::size_t triangle) {
  glm::vec3 a = shape.positions[shape.indices[3 * triangle]];
  glm::vec3 b = shape.positions[shape.indices[3 * triangle + 1]];
  glm::vec3 c = shape.positions[shape.indices[3 * triangle + 2]];
  return glm::cross(b - a, c - a);
}

void copyVertex(Shape& to, const Shape& from, std::size_t vertex) {
  auto copy = [vertex](auto& target, const auto& source) {
    if (!source.empty()) target.push_back(source[vertex]);
  };
  copy(to.positions, from.positions);
  copy(to.uvs, from.uvs);
  copy(to.uvsSecond, from.uvsSecond);
  copy(to.colors, from.colors);
  copy(to.joints, from.joints);
  copy(to.jointWeights, from.jointWeights);
  copy(to.morphPositions, from.morphPositions);
  copy(to.morphNormals, from.morphNormals);
}

glm::vec3 unitOr(glm::vec3 v, glm::vec3 otherwise) {
  float length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

std::uint8_t unorm8(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

} // namespace

Shape gridShape(int uCells, int vCells, GridTopology topology,
                const std::function<glm::vec3(float u, float v)>& position) {
  Shape shape;
  for (int j = 0; j <= vCells; ++j) {
    for (int i = 0; i <= uCells; ++i) {
      bool pole = (topology.poleAtStart && j == 0) || (topology.poleAtEnd && j == vCells);
      int columnOfPosition = pole || (topology.closedU && i == uCells) ? 0 : i;
      int rowOfPosition = topology.closedV && j == vCells ? 0 : j;
      auto fraction = [](int step, int count) { return static_cast<float>(step) / static_cast<float>(count); };
      shape.positions.push_back(position(fraction(columnOfPosition, uCells), fraction(rowOfPosition, vCells)));
      shape.uvs.push_back({fraction(i, uCells), fraction(j, vCells)});
    }
  }
  auto addTriangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    PositionKey keyA = positionKey(shape.positions[a]);
    PositionKey keyB = positionKey(shape.positions[b]);
    PositionKey keyC = positionKey(shape.positions[c]);
    if (keyA == keyB || keyB == keyC || keyC == keyA) return;
    shape.indices.insert(shape.indices.end(), {a, b, c});
  };
  for (int j = 0; j < vCells; ++j) {
    for (int i = 0; i < uCells; ++i) {
      auto corner = static_cast<std::uint32_t>(j * (uCells + 1) + i);
      auto above = corner + static_cast<std::uint32_t>(uCells + 1);
      addTriangle(corner, corner + 1, above + 1);
      addTriangle(corner, above + 1, above);
    }
  }
  return shape;
}

void smoothNormals(Shape& shape, float creaseDegrees) {
  const float cosineOfCrease = std::cos(glm::radians(creaseDegrees));
  const std::vector<std::uint32_t> welded = weldedIndices(shape.positions);
  const std::size_t triangleCount = shape.indices.size() / 3;
  std::vector<std::vector<std::uint32_t>> facesAround(shape.positions.size());
  std::vector<glm::vec3> faces(triangleCount);
  for (std::size_t t = 0; t < triangleCount; ++t) {
    faces[t] = faceVector(shape, t);
    for (int k = 0; k < 3; ++k) facesAround[welded[shape.indices[3 * t + k]]].push_back(static_cast<std::uint32_t>(t));
  }

  Shape split;
  std::map<std::array<std::uint32_t, 4>, std::uint32_t> corners;
  for (std::size_t t = 0; t < triangleCount; ++t) {
    glm::vec3 own = unitOr(faces[t], glm::vec3(0, 1, 0));
    for (int k = 0; k < 3; ++k) {
      std::uint32_t vertex = shape.indices[3 * t + k];
      glm::vec3 sum(0);
      for (std::uint32_t face : facesAround[welded[vertex]]) {
        if (glm::dot(unitOr(faces[face], own), own) >= cosineOfCrease) sum += faces[face];
      }
      glm::vec3 normal = unitOr(sum, own);
      // Corners of one vertex that sum the same faces get the same bits, since the order of the faces is fixed.
      PositionKey key = positionKey(normal);
      auto [found, isNew] =
          corners.try_emplace({vertex, key[0], key[1], key[2]}, static_cast<std::uint32_t>(split.positions.size()));
      if (isNew) {
        copyVertex(split, shape, vertex);
        split.normals.push_back(normal);
      }
      split.indices.push_back(found->second);
    }
  }
  shape = std::move(split);
}

double signedVolume(const Shape& shape) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3) {
    glm::dvec3 a(shape.positions[shape.indices[i]]);
    glm::dvec3 b(shape.positions[shape.indices[i + 1]]);
    glm::dvec3 c(shape.positions[shape.indices[i + 2]]);
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum / 6;
}

void flipTriangles(Shape& shape) {
  for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3) std::swap(shape.indices[i + 1], shape.indices[i + 2]);
  for (glm::vec3& normal : shape.normals) normal = -normal;
}

void orientOutward(Shape& shape) {
  if (signedVolume(shape) < 0) flipTriangles(shape);
}

void append(Shape& shape, const Shape& other) {
  auto base = static_cast<std::uint32_t>(shape.positions.size());
  auto join = [](auto& target, const auto& source) { target.insert(target.end(), source.begin(), source.end()); };
  join(shape.positions, other.positions);
  join(shape.normals, other.normals);
  join(shape.uvs, other.uvs);
  join(shape.uvsSecond, other.uvsSecond);
  join(shape.colors, other.colors);
  join(shape.joints, other.joints);
  join(shape.jointWeights, other.jointWeights);
  join(shape.morphPositions, other.morphPositions);
  join(shape.morphNormals, other.morphNormals);
  for (std::uint32_t index : other.indices) shape.indices.push_back(base + index);
}

void transform(Shape& shape, const glm::mat4& destinationFromShape) {
  const glm::mat3 normalsFromShape = normalMatrix(destinationFromShape) * mirrorSign(destinationFromShape);
  for (glm::vec3& p : shape.positions) p = transformPoint(destinationFromShape, p);
  for (glm::vec3& n : shape.normals) n = unitOr(normalsFromShape * n, n);
  for (glm::vec3& p : shape.morphPositions) p = transformDirection(destinationFromShape, p);
  for (glm::vec3& n : shape.morphNormals) n = normalsFromShape * n;
  if (mirrorSign(destinationFromShape) < 0) {
    for (std::size_t i = 0; i + 2 < shape.indices.size(); i += 3) std::swap(shape.indices[i + 1], shape.indices[i + 2]);
  }
}

void paint(Shape& shape, glm::vec3 colorLinear) {
  shape.colors.assign(shape.positions.size(),
                      {unorm8(colorLinear.x), unorm8(colorLinear.y), unorm8(colorLinear.z), 255});
}

void paint(Shape& shape, const std::function<glm::vec3(glm::vec3 position)>& colorLinear) {
  shape.colors.clear();
  for (glm::vec3 p : shape.positions) {
    glm::vec3 color = colorLinear(p);
    shape.colors.push_back({unorm8(color.x), unorm8(color.y), unorm8(color.z), 255});
  }
}

} // namespace brickfield::scenes
