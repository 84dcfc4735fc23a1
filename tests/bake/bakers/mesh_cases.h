// Meshes that the baker's tests share, and brute-force truth about them in double.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "bakers/bake.h"
#include "bakers/triangle_soup.h"
#include "scene/gltf_import.h"
#include "tests/support/data.h"

namespace brickfield::test {

/// A scene of one mesh of one primitive with a material of its own; what most tests bake.
struct MeshCase {
  Scene scene;

  MeshCase() {
    scene.materials.emplace_back();
    scene.meshes.emplace_back().primitives.emplace_back().material = 0;
  }
  Primitive& primitive() { return scene.meshes[0].primitives[0]; }
  Material& material() { return scene.materials[0]; }

  void addTriangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    for (const glm::vec3 corner : {a, b, c}) {
      primitive().indices.push_back(static_cast<std::uint32_t>(primitive().positions.size()));
      primitive().positions.push_back(corner);
    }
  }
  /// Corners in the order of the front's turn.
  void addQuad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) { addTriangle(a, b, c), addTriangle(a, c, d); }

  /// A box with outward faces; inverted: inward.
  void addBox(glm::vec3 min, glm::vec3 max, bool inverted = false) {
    const auto corner = [&](int i) {
      return glm::vec3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
    };
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces)
      if (inverted)
        addQuad(corner(f[3]), corner(f[2]), corner(f[1]), corner(f[0]));
      else
        addQuad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
  }

  /// Sphere of latitude and longitude; from is the ring to begin with (rings / 2: the lower half, open above).
  void addSphere(glm::vec3 center, float radius, int rings, int segments, int from = 0) {
    const auto vertex = [&](int ring, int segment) {
      const double polar = std::numbers::pi * ring / rings;
      const double azimuth = 2.0 * std::numbers::pi * (segment % segments) / segments;
      const double sine = ring == 0 || ring == rings ? 0.0 : std::sin(polar);
      return center +
             radius * glm::vec3(glm::dvec3(sine * std::cos(azimuth), std::cos(polar), -sine * std::sin(azimuth)));
    };
    for (int ring = from; ring < rings; ++ring)
      for (int segment = 0; segment < segments; ++segment) {
        const glm::vec3 a = vertex(ring, segment), b = vertex(ring + 1, segment), c = vertex(ring + 1, segment + 1),
                        d = vertex(ring, segment + 1);
        if (ring + 1 < rings) addTriangle(a, b, c);
        if (ring > 0) addTriangle(a, c, d);
      }
  }

  BakeInput input(const std::string& label = "case") const {
    BakeInput result;
    result.label = label;
    result.scene = &scene;
    for (const Primitive& p : scene.meshes[0].primitives) {
      result.primitives.push_back(&p);
      result.positionsObject.push_back(p.positions);
    }
    return result;
  }
  TriangleSoup soup() const { return gatherTriangles(input()); }
};

/// The first mesh of a file, at rest.
struct FileCase {
  Scene scene;
  explicit FileCase(std::string_view name) : scene(importGltf(dataFile(name))) {}
  BakeInput input() const {
    PosedInstance instance;
    instance.node = 0;
    instance.mesh = 0;
    instance.morphWeights = scene.meshes[0].morphWeights;
    return bakeInputOf(scene, instance);
  }
};

inline std::vector<std::uint32_t> allTriangles(const TriangleSoup& soup) {
  std::vector<std::uint32_t> all(soup.triangles.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

/// Distance to a triangle by the regions of Ericson, Real-Time Collision Detection, 2005, 5.1.5: other formulas than
/// the baker's, in long double.
inline double bruteDistance(glm::dvec3 point, const std::array<glm::dvec3, 3>& corners) {
  using Vector = glm::tvec3<long double>;
  const Vector p(point), a(corners[0]), b(corners[1]), c(corners[2]), ab = b - a, ac = c - a;
  const auto to = [&](Vector q) { return static_cast<double>(glm::length(p - q)); };
  const long double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return to(a);
  const long double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return to(b);
  const long double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(a + d1 / (d1 - d3) * ab);
  const long double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return to(c);
  const long double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(a + d2 / (d2 - d6) * ac);
  const long double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return to(b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b));
  return static_cast<double>(std::abs(glm::dot(p - a, glm::normalize(glm::cross(ab, ac)))));
}

/// Distance to all triangles of a soup, in soup space.
inline double bruteDistance(const TriangleSoup& soup, glm::dvec3 point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    least = std::min(least, bruteDistance(point, soup.corners(t)));
  return least;
}

/// Winding number by all solid angles (Van Oosterom and Strackee 1983), in double.
inline double bruteWinding(const TriangleSoup& soup, glm::dvec3 point) {
  double sum = 0;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const auto corners = soup.corners(t);
    const glm::dvec3 a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

/// Points spread evenly over a cube around zero, in soup space.
inline std::vector<glm::dvec3> randomPoints(int count, double halfEdge, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-halfEdge, halfEdge);
  std::vector<glm::dvec3> points(static_cast<std::size_t>(count));
  for (glm::dvec3& point : points) {
    point.x = coordinate(random);
    point.y = coordinate(random);
    point.z = coordinate(random);
  }
  return points;
}

/// Points close to a soup's surface: on random triangles, moved by up to `reach` along each axis.
inline std::vector<glm::dvec3> pointsNearSurface(const TriangleSoup& soup, int count, double reach,
                                                 std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<glm::dvec3> points = randomPoints(count, reach, seed + 1);
  std::uniform_int_distribution<std::uint32_t> triangle(0, static_cast<std::uint32_t>(soup.triangles.size() - 1));
  std::uniform_real_distribution<double> share(0, 0.5);
  for (glm::dvec3& point : points) {
    const auto [a, b, c] = soup.corners(triangle(random));
    const double v = share(random), w = share(random);
    point += a + v * (b - a) + w * (c - a);
  }
  return points;
}

} // namespace brickfield::test
