// Lengths of pseudonormals do not matter, only the sides that they tell apart.
#include "bakers/pseudonormals.h"

#include <algorithm>
#include <cmath>

namespace brickfield {

namespace {

glm::dvec3 faceNormal(const TriangleSoup& soup, std::uint32_t triangle) {
  const auto [a, b, c] = soup.corners(triangle);
  return glm::normalize(glm::cross(b - a, c - a));
}

double cornerAngle(const std::array<glm::dvec3, 3>& corners, std::size_t k) {
  const glm::dvec3 next = glm::normalize(corners[(k + 1) % 3] - corners[k]);
  const glm::dvec3 last = glm::normalize(corners[(k + 2) % 3] - corners[k]);
  return std::atan2(glm::length(glm::cross(next, last)), glm::dot(next, last));
}

} // namespace

std::optional<Pseudonormals> Pseudonormals::of(const TriangleSoup& soup) {
  Pseudonormals result;
  result.soup_ = &soup;
  result.neighbours_ = closedManifoldNeighbours(soup);
  if (result.neighbours_.empty()) return std::nullopt;
  result.cornerNormals_.assign(soup.positions.size(), glm::dvec3(0.0));
  double volume = 0; // six times, with sign
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const std::array<glm::dvec3, 3> corners = soup.corners(t);
    volume += glm::dot(corners[0], glm::cross(corners[1], corners[2]));
    for (std::size_t k = 0; k < 3; ++k)
      result.cornerNormals_[soup.triangles[t][k]] += cornerAngle(corners, k) * faceNormal(soup, t);
  }
  result.facing_ = volume < 0 ? -1 : 1;
  return result;
}

bool Pseudonormals::isInside(glm::dvec3 point, const ClosestTriangle& closest) const {
  glm::dvec3 normal = faceNormal(*soup_, closest.triangle);
  const auto feature = static_cast<std::size_t>(closest.on.feature);
  if (closest.on.feature <= TriangleFeature::Corner2)
    normal = cornerNormals_[soup_->triangles[closest.triangle][feature]];
  else if (closest.on.feature <= TriangleFeature::Edge2)
    normal += faceNormal(*soup_, neighbours_[closest.triangle][feature - 3]);
  return facing_ * glm::dot(normal, point - closest.on.point) < 0;
}

} // namespace brickfield
