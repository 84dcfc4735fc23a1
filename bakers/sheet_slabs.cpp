// Sides by pseudonormals, as in pseudonormals.h, but of open surfaces: at a rim the slab ends in a flat face, so that
// it does not bulge far beyond the triangle's outline.
#include "bakers/sheet_slabs.h"

#include <algorithm>
#include <cmath>

namespace brickfield {

namespace {

struct EdgeUse {
  std::uint64_t key = 0; ///< smaller vertex, larger vertex
  std::uint32_t triangle = 0;
  std::uint8_t corner = 0; ///< edge from this corner to the next
};

std::vector<EdgeUse> sortedUses(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t from = soup.triangles[t][k], to = soup.triangles[t][(k + 1u) % 3u];
      uses.push_back({(std::uint64_t{std::min(from, to)} << 32) | std::max(from, to), t, k});
    }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  return uses;
}

double angleAt(const std::array<glm::dvec3, 3>& corners, std::size_t k) {
  const glm::dvec3 a = glm::normalize(corners[(k + 1) % 3] - corners[k]);
  const glm::dvec3 b = glm::normalize(corners[(k + 2) % 3] - corners[k]);
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

/// Unit where the sum has a direction, else the fallback.
glm::dvec3 unitOr(glm::dvec3 sum, glm::dvec3 fallback) {
  const double length = glm::length(sum);
  return length > 1e-6 ? sum / length : fallback;
}

} // namespace

SheetSlabs::SheetSlabs(const TriangleSoup& soup, const MeshHierarchy& sheets, const SlabRequest& request)
    : soup_(&soup),
      pieceShare_(request.pieceShare),
      isBehind_(soup.triangles.size(), false),
      hasWideRim_(request.isDoubleSided),
      isTurned_(request.isTurned) {
  const MeshDistance distance(sheets);
  std::vector<std::uint32_t> behind;
  for (const HierarchyLeaf& leaf : sheets.leaves())
    for (std::uint32_t i = 0; i < leaf.count(); ++i)
      if (const std::uint32_t t = leaf.triangles[i];
          request.mayLieBehind[t] && !isThin(t, distance, depthOf(request.halfThickness)))
        behind.push_back(t);
  std::sort(behind.begin(), behind.end());
  for (const std::uint32_t t : behind) isBehind_[t] = true;
  if (!behind.empty()) connect(behind);
}

/// Whether the slab behind a triangle would come out of the front of another: of two layers back to back, each then
/// ends the other's slab, and both vanish where they are closer than the samples.
bool SheetSlabs::isThin(std::uint32_t triangle, const MeshDistance& sheets, double thickness) const {
  const auto corners = soup_->corners(triangle);
  const glm::dvec3 normal = normalOf(triangle), centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
  const auto comesOut = [&](glm::dvec3 place) {
    const glm::dvec3 behind = place - thickness * normal;
    const ClosestTriangle closest = sheets.closest(behind, HUGE_VAL, triangle);
    const glm::dvec3 front = normalOf(closest.triangle);
    return glm::dot(front, normal) < 0 && glm::dot(behind - closest.on.point, front) > 0;
  };
  if (comesOut(centroid)) return true;
  return std::any_of(corners.begin(), corners.end(),
                     [&](glm::dvec3 corner) { return comesOut(glm::mix(corner, centroid, 0.25)); });
}

glm::dvec3 SheetSlabs::normalOf(std::uint32_t triangle) const {
  const auto [a, b, c] = soup_->corners(triangle);
  return glm::normalize(isTurned_[triangle] ? glm::cross(c - a, b - a) : glm::cross(b - a, c - a));
}

void SheetSlabs::connect(const std::vector<std::uint32_t>& behind) {
  neighbours_.assign(soup_->triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  sideOfVertex_.resize(soup_->positions.size());
  const std::vector<EdgeUse> uses = sortedUses(*soup_, behind);
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].key == uses[begin].key) ++end;
    if (end - begin == 1) {
      sideOfVertex_[uses[begin].key >> 32].isRim = true;
      sideOfVertex_[uses[begin].key & 0xffffffffu].isRim = true;
      continue;
    }
    for (std::size_t i = begin; i < end; ++i)
      neighbours_[uses[i].triangle][uses[i].corner] = uses[i + 1 < end ? i + 1 : begin].triangle;
  }
  for (const std::uint32_t t : behind) {
    const auto corners = soup_->corners(t);
    for (std::size_t k = 0; k < 3; ++k)
      sideOfVertex_[soup_->triangles[t][k]].normal += angleAt(corners, k) * normalOf(t);
  }
  for (const std::uint32_t t : behind)
    for (const std::uint32_t vertex : soup_->triangles[t])
      sideOfVertex_[vertex].normal = unitOr(sideOfVertex_[vertex].normal, normalOf(t));
}

SheetSlabs::Side SheetSlabs::sideAt(const ClosestTriangle& closest) const {
  const TriangleFeature feature = closest.on.feature;
  if (feature == TriangleFeature::Inside) return {normalOf(closest.triangle), false};
  const auto k = static_cast<std::size_t>(feature);
  if (feature <= TriangleFeature::Corner2) return sideOfVertex_[soup_->triangles[closest.triangle][k]];
  const std::uint32_t neighbour = neighbours_[closest.triangle][k - static_cast<std::size_t>(TriangleFeature::Edge0)];
  const glm::dvec3 own = normalOf(closest.triangle);
  if (neighbour == kNoTriangle) return {own, true};
  return {unitOr(own + normalOf(neighbour), own), false};
}

double SheetSlabs::centredDistance(std::uint32_t triangle, double distance, double halfThickness) const {
  return distance - (triangle < soup_->firstPiece() ? 1.0 : pieceShare_) * halfThickness;
}

void SheetSlabs::centreDistances(std::span<float> distances, const std::uint32_t* triangles,
                                 double halfThickness) const {
  const double ofPieces = pieceShare_ * halfThickness;
  if (!triangles) {
    for (float& distance : distances) distance = static_cast<float>(static_cast<double>(distance) - halfThickness);
    return;
  }
  const auto firstPiece = static_cast<std::uint32_t>(soup_->firstPiece());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double half = triangles[i] < firstPiece ? halfThickness : ofPieces;
    distances[i] = static_cast<float>(static_cast<double>(distances[i]) - half);
  }
}

/// To a slab behind, off rims.
double SheetSlabs::smoothDistance(bool isBefore, double distance, double halfThickness) {
  const double middle = 0.5 * depthOf(halfThickness);
  return isBefore ? distance : std::abs(distance - middle) - middle;
}

double SheetSlabs::distanceOver(std::uint32_t triangle, double height, double halfThickness) const {
  return smoothDistance((height < 0) == isTurned_[triangle], std::abs(height), halfThickness);
}

double SheetSlabs::distance(glm::dvec3 point, const ClosestTriangle& closest, double halfThickness) const {
  if (!isBehind_[closest.triangle]) return centredDistance(closest.triangle, closest.distance, halfThickness);
  const double middle = 0.5 * depthOf(halfThickness);
  const Side side = sideAt(closest);
  const glm::dvec3 offset = point - closest.on.point;
  const double height = glm::dot(offset, side.normal);
  if (!side.isRim) return smoothDistance(height >= 0, closest.distance, halfThickness);
  const double width = (hasWideRim_[closest.triangle] ? 1.0 : 0.5) * halfThickness;
  const double beside = std::sqrt(std::max(0.0, glm::dot(offset, offset) - height * height)) - width;
  const double across = std::abs(height + middle) - middle;
  return std::hypot(std::max(beside, 0.0), std::max(across, 0.0)) + std::min(std::max(beside, across), 0.0);
}

void SheetSlabs::growBounds(const std::vector<std::uint32_t>& sheets, double halfThickness, glm::dvec3& low,
                            glm::dvec3& high) const {
  for (const std::uint32_t t : sheets)
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 corner = soup_->corners(t)[k];
      if (!isBehind_[t]) {
        low = glm::min(low, corner - halfThickness), high = glm::max(high, corner + halfThickness);
        continue;
      }
      for (const glm::dvec3 normal : {normalOf(t), sideOfVertex_[soup_->triangles[t][k]].normal}) {
        const glm::dvec3 back = corner - depthOf(halfThickness) * normal;
        low = glm::min(low, back), high = glm::max(high, back);
      }
    }
}

} // namespace brickfield
