// The two sides are looked at half a thickness away: where the solid behind a triangle is thinner than that, the sheet
// shows more of it than the solid would.
#include "bakers/sheets.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bakers/inside_test.h"

namespace brickfield {

namespace {

constexpr double kVoxelsPerPlace = 8; // a place stands for a brick's worth of triangle
constexpr int kMostPlacesPerSide = 4;
constexpr int kMostRounds = 8;

enum class Verdict : std::uint8_t { Solid, Both, Sheet };

/// Whether there is open space on both sides of one place of a triangle.
bool isOpenOnBothSides(const SolidWinding& winding, glm::dvec3 place, glm::dvec3 offset) {
  return !winding.isInside(place - offset) && !winding.isInside(place + offset);
}

/// Calls `visit` with the centroids of the n^2 equal parts of a triangle.
template <typename Visit>
void forEachPlace(const std::array<glm::dvec3, 3>& corners, int partsPerSide, Visit visit) {
  const glm::dvec3 stepB = (corners[1] - corners[0]) / static_cast<double>(partsPerSide);
  const glm::dvec3 stepC = (corners[2] - corners[0]) / static_cast<double>(partsPerSide);
  for (int j = 0; j < partsPerSide; ++j)
    for (int i = 0; i + j < partsPerSide; ++i) {
      const glm::dvec3 corner = corners[0] + static_cast<double>(i) * stepB + static_cast<double>(j) * stepC;
      visit(corner + (stepB + stepC) / 3.0);
      if (i + j + 1 < partsPerSide) visit(corner + (stepB + stepC) * (2.0 / 3.0));
    }
}

Verdict judge(const std::array<glm::dvec3, 3>& corners, const SolidWinding& winding, const SheetRequest& request) {
  const glm::dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
  const double longest = std::max({glm::length(ab), glm::length(ac), glm::length(bc)});
  const double parts = std::ceil(longest / (kVoxelsPerPlace * request.voxelSize));
  const glm::dvec3 offset = request.halfThickness * glm::normalize(glm::cross(ab, ac));
  int places = 0, openPlaces = 0;
  forEachPlace(corners, static_cast<int>(std::clamp<double>(parts, 1, kMostPlacesPerSide)), [&](glm::dvec3 place) {
    ++places;
    openPlaces += isOpenOnBothSides(winding, place, offset);
  });
  if (openPlaces == 0) return Verdict::Solid;
  return openPlaces == places ? Verdict::Sheet : Verdict::Both;
}

std::vector<Verdict> judgeAll(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles,
                              const SolidWinding& winding, const SheetRequest& request) {
  std::vector<Verdict> verdicts(triangles.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(),
                    [&](std::size_t i) { verdicts[i] = judge(soup.corners(triangles[i]), winding, request); });
  return verdicts;
}

} // namespace

SolidsAndSheets findSheets(const TriangleSoup& soup, const MeshTopology& topology, const SheetRequest& request) {
  SolidsAndSheets result;
  std::vector<std::uint32_t> closed, open, flatPairs;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    if (topology.isFlatPair[t]) {
      if (!topology.isFlatPairCopy[t]) flatPairs.push_back(t);
    } else if (topology.inClosedComponent[t]) {
      closed.push_back(t);
    } else if (request.isCutOut[t]) {
      result.sheets.push_back(t);
    } else {
      open.push_back(t);
    }
  }
  result.solid = closed;
  if (open.empty() && flatPairs.empty()) return result;

  std::vector<std::uint32_t> partlySheets;
  for (int round = 0; round < kMostRounds; ++round) {
    result.solid = closed;
    result.solid.insert(result.solid.end(), open.begin(), open.end());
    const SolidWinding winding(soup, topology, result.solid, false);
    const std::vector<Verdict> verdicts = judgeAll(soup, open, winding, request);
    std::vector<std::uint32_t> left;
    partlySheets.clear();
    for (std::size_t i = 0; i < open.size(); ++i) {
      (verdicts[i] == Verdict::Sheet ? result.sheets : left).push_back(open[i]);
      if (verdicts[i] == Verdict::Both) partlySheets.push_back(open[i]);
    }
    const bool isSettled = left.size() == open.size();
    open = std::move(left);
    if (!isSettled && round + 1 < kMostRounds) continue;
    const std::vector<Verdict> ofPairs = judgeAll(soup, flatPairs, winding, request);
    for (std::size_t i = 0; i < flatPairs.size(); ++i)
      if (ofPairs[i] != Verdict::Solid) result.sheets.push_back(flatPairs[i]);
    break;
  }
  result.solid = closed;
  result.solid.insert(result.solid.end(), open.begin(), open.end());
  result.sheets.insert(result.sheets.end(), partlySheets.begin(), partlySheets.end());
  std::sort(result.solid.begin(), result.solid.end());
  std::sort(result.sheets.begin(), result.sheets.end());
  return result;
}

} // namespace brickfield
