// The two sides are looked at half a thickness away: where the solid behind a triangle is thinner than that, the sheet
// shows more of it than the solid would.
#include "bakers/sheets.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <tbb/parallel_for.h>

#include "bakers/inside_test.h"

namespace brickfield {

namespace {

constexpr double kVoxelsPerPlace = 8; // a place stands for a brick's worth of triangle
constexpr int kMostPlacesPerSide = 4;
constexpr int kMostRounds = 64;

enum class Verdict : std::uint8_t { Solid, Both, Sheet };

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

/// Where a triangle is looked at.
class TrianglePlaces {
public:
  TrianglePlaces(const TriangleSoup& soup, const SheetRequest& request, std::uint32_t triangle)
      : corners_(soup.corners(triangle)) {
    const glm::dvec3 ab = corners_[1] - corners_[0], ac = corners_[2] - corners_[0], bc = corners_[2] - corners_[1];
    const double longest = std::max({glm::length(ab), glm::length(ac), glm::length(bc)});
    const double parts = std::ceil(longest / (kVoxelsPerPlace * request.voxelSize));
    partsPerSide_ = static_cast<int>(std::clamp<double>(parts, 1, kMostPlacesPerSide));
    toFront_ = request.halfThickness * glm::normalize(glm::cross(ab, ac));
  }
  std::size_t count() const { return static_cast<std::size_t>(partsPerSide_ * partsPerSide_); }

  /// Calls visit(number, point behind, point before).
  template <typename Visit>
  void forEach(Visit visit) const {
    std::size_t number = 0;
    forEachPlace(corners_, partsPerSide_,
                 [&](glm::dvec3 place) { visit(number++, place - toFront_, place + toFront_); });
  }

private:
  std::array<glm::dvec3, 3> corners_;
  int partsPerSide_ = 1;
  glm::dvec3 toFront_;
};

/// Judges triangles by what is left of the open ones. The winding numbers behind the places are kept, and brought up to
/// date by those of the triangles that were taken out since: almost all triangles are solid by what is behind them.
class SheetJudge {
public:
  SheetJudge(const TriangleSoup& soup, const SheetRequest& request, const MeshTopology& topology,
             const std::vector<std::uint32_t>& closed, const std::vector<std::uint32_t>& open)
      : soup_(soup),
        request_(request),
        closed_(soup, topology, closed, false),
        firstPlace_(soup.triangles.size()),
        partsBehind_(soup.triangles.size(), 0) {
    std::uint32_t placeCount = 0;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      firstPlace_[t] = placeCount;
      placeCount += static_cast<std::uint32_t>(TrianglePlaces(soup, request, t).count());
    }
    windingBehind_.assign(placeCount, 0.0f);
    if (!open.empty()) parts_.push_back(std::make_unique<Part>(soup, open));
  }

  /// Takes triangles out of the open ones.
  void remove(const std::vector<std::uint32_t>& triangles) {
    parts_.push_back(std::make_unique<Part>(soup_, triangles));
  }

  std::vector<Verdict> judge(const std::vector<std::uint32_t>& triangles) {
    std::vector<Verdict> verdicts(triangles.size());
    tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t i) { verdicts[i] = judgeOne(triangles[i]); });
    return verdicts;
  }

private:
  struct Part {
    MeshHierarchy hierarchy;
    WindingNumber winding;
    Part(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles)
        : hierarchy(soup, triangles), winding(hierarchy) {}
  };

  /// Winding number of the parts from `first` on: all open triangles count, later parts were taken out of them.
  float windingOf(std::size_t first, glm::dvec3 point) const {
    float sum = 0;
    for (std::size_t i = first; i < parts_.size(); ++i)
      sum += i == 0 ? parts_[i]->winding.at(point) : -parts_[i]->winding.at(point);
    return sum;
  }

  Verdict judgeOne(std::uint32_t triangle) {
    const TrianglePlaces places(soup_, request_, triangle);
    std::size_t openPlaces = 0;
    places.forEach([&](std::size_t number, glm::dvec3 behind, glm::dvec3 before) {
      float& winding = windingBehind_[firstPlace_[triangle] + number];
      winding += windingOf(partsBehind_[triangle], behind);
      if (winding >= 0.5f || closed_.excess(behind) >= 0) return;
      openPlaces += windingOf(0, before) < 0.5f && closed_.excess(before) < 0;
    });
    partsBehind_[triangle] = static_cast<std::uint32_t>(parts_.size());
    if (openPlaces == 0) return Verdict::Solid;
    return openPlaces == places.count() ? Verdict::Sheet : Verdict::Both;
  }

  const TriangleSoup& soup_;
  const SheetRequest& request_;
  SolidWinding closed_;
  std::vector<std::unique_ptr<Part>> parts_; ///< all open triangles, then what was taken out
  std::vector<std::uint32_t> firstPlace_;    ///< a triangle
  std::vector<std::uint32_t> partsBehind_;   ///< a triangle: parts that windingBehind_ has counted
  std::vector<float> windingBehind_;         ///< a place
};

/// Open triangles, sorted out.
struct OpenTriangles {
  std::vector<std::uint32_t> solid, sheets;
};

OpenTriangles sortOut(SheetJudge& judge, std::vector<std::uint32_t> open) {
  OpenTriangles result;
  std::vector<Verdict> verdicts;
  for (int round = 0; round < kMostRounds; ++round) {
    verdicts = judge.judge(open);
    std::vector<std::uint32_t> left, found;
    for (std::size_t i = 0; i < open.size(); ++i) (verdicts[i] == Verdict::Sheet ? found : left).push_back(open[i]);
    if (found.empty()) break;
    judge.remove(found);
    result.sheets.insert(result.sheets.end(), found.begin(), found.end());
    open = std::move(left);
  }
  verdicts = judge.judge(open);
  for (std::size_t i = 0; i < open.size(); ++i)
    if (verdicts[i] != Verdict::Solid) result.sheets.push_back(open[i]);
  result.solid = std::move(open);
  return result;
}

} // namespace

SolidsAndSheets findSheets(const TriangleSoup& soup, const MeshTopology& topology, const SheetRequest& request) {
  SolidsAndSheets result;
  std::vector<std::uint32_t> open, flatPairs;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    if (topology.isFlatPair[t]) {
      if (!topology.isFlatPairCopy[t]) flatPairs.push_back(t);
    } else if (topology.inClosedComponent[t]) {
      result.solid.push_back(t);
    } else if (request.isCutOut[t]) {
      result.sheets.push_back(t);
    } else {
      open.push_back(t);
    }
  }
  if (open.empty() && flatPairs.empty()) return result;

  SheetJudge judge(soup, request, topology, result.solid, open);
  const OpenTriangles sorted = sortOut(judge, std::move(open));
  result.solid.insert(result.solid.end(), sorted.solid.begin(), sorted.solid.end());
  result.sheets.insert(result.sheets.end(), sorted.sheets.begin(), sorted.sheets.end());
  const std::vector<Verdict> ofPairs = judge.judge(flatPairs);
  for (std::size_t i = 0; i < flatPairs.size(); ++i)
    if (ofPairs[i] != Verdict::Solid) result.sheets.push_back(flatPairs[i]);
  std::sort(result.solid.begin(), result.solid.end());
  std::sort(result.sheets.begin(), result.sheets.end());
  return result;
}

} // namespace brickfield
