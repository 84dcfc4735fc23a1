// Winding numbers are taken a thickness behind the triangles and half of one before: a solid that is thinner than a
// slab could fall between the samples.
#include "bakers/sheets.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bakers/each_uneven.h"

namespace brickfield {

namespace {

constexpr double kVoxelsPerPlace = 8; // a place stands for a brick's worth of triangle
constexpr int kMostPlacesPerSide = 4;
constexpr std::size_t kMostPlaces = kMostPlacesPerSide * kMostPlacesPerSide;
constexpr int kMostRounds = 64;

// Mean turn around the triangles from which an open component counts as a solid. Open scans, teapots and aeroplanes
// with windows cut out have 0.95 and more, a cube without a lid 0.90, half a sphere 0.80, a room of three walls 0.75,
// a pyramid without its base 0.57, a plane 1/2.
constexpr double kClosedTwoSided = 0.92;
constexpr double kClosedOneSided = 0.70;
constexpr std::size_t kEnoughTriangles = 2048;
// A mean over n places of values from 0 to 1 is off by 0.5 / sqrt(n) or less in two of three cases.
constexpr double kClearDeviations = 4 * 0.5;
constexpr double kLeastFlapShare = 0.02; // of a component's area; less is the rim of a spout or of a hole

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

  /// Where a place's back and its front are looked at.
  glm::dvec3 behind(std::size_t number) const { return place(number) - 2.0 * toFront_; }
  glm::dvec3 before(std::size_t number) const { return place(number) + toFront_; }

private:
  /// The centroid of one of the n^2 equal parts, row by row: of n upright ones and, between them, n - 1 turned over; of
  /// one less each in the next row.
  glm::dvec3 place(std::size_t number) const {
    const glm::dvec3 stepB = (corners_[1] - corners_[0]) / static_cast<double>(partsPerSide_);
    const glm::dvec3 stepC = (corners_[2] - corners_[0]) / static_cast<double>(partsPerSide_);
    int row = 0, left = static_cast<int>(number);
    for (; left >= 2 * (partsPerSide_ - row) - 1; ++row) left -= 2 * (partsPerSide_ - row) - 1;
    const glm::dvec3 corner = corners_[0] + static_cast<double>(left / 2) * stepB + static_cast<double>(row) * stepC;
    return corner + (stepB + stepC) * (left % 2 == 0 ? 1.0 / 3 : 2.0 / 3);
  }

  std::array<glm::dvec3, 3> corners_;
  int partsPerSide_ = 1;
  glm::dvec3 toFront_;
};

/// Looks at triangles by what is left of the open ones. The winding numbers at the places are kept, and brought up to
/// date by those of the triangles that were taken out since.
class SheetJudge {
public:
  /// looked  triangles that will be looked at, the open ones among them
  SheetJudge(const TriangleSoup& soup, const SheetRequest& request, SolidWinding closed,
             const std::vector<std::uint32_t>& open, const std::vector<std::uint32_t>& looked)
      : soup_(soup), request_(request), closed_(std::move(closed)), firstPlace_(soup.triangles.size()) {
    std::uint32_t placeCount = 0;
    for (const std::uint32_t t : looked) {
      firstPlace_[t] = placeCount;
      placeCount += static_cast<std::uint32_t>(TrianglePlaces(soup, request, t).count());
    }
    sides_.resize(std::size_t{2} * placeCount);
    if (!open.empty()) parts_.emplace_back(soup, open);
  }

  /// Takes triangles out of the open ones; where fewer are left, those are asked from now on.
  void remove(const std::vector<std::uint32_t>& triangles, const std::vector<std::uint32_t>& left) {
    if (left.size() > triangles.size()) {
      parts_.emplace_back(soup_, triangles);
      return;
    }
    parts_.clear();
    std::fill(sides_.begin(), sides_.end(), Side{});
    if (!left.empty()) parts_.emplace_back(soup_, left);
  }

  /// How far each triangle's side that is more inside is wrapped, 0 to 1: at one place, or in the mean of all.
  std::vector<double> closures(const std::vector<std::uint32_t>& triangles, bool isOneEnough) {
    std::vector<double> result(triangles.size());
    forEachUneven(triangles.size(), 8, [&](std::size_t i) {
      const std::uint32_t t = triangles[i];
      const TrianglePlaces places(soup_, request_, t);
      if (isOneEnough) {
        result[i] = closureAt(places, t, t * kStride % places.count());
        return;
      }
      for (std::size_t number = 0; number < places.count(); ++number) result[i] += closureAt(places, t, number);
      result[i] /= static_cast<double>(places.count());
    });
    return result;
  }

  /// What a place adds to its triangle's mean for certain, and by how much less that is than if it were wrapped.
  struct PlaceShare {
    double least = 0, lost = 0;
  };
  /// Of some places of each triangle together, nothing where it has fewer; by its back alone, or by both sides.
  std::vector<PlaceShare> placeShares(const std::vector<std::uint32_t>& triangles, std::size_t first, std::size_t count,
                                      bool isBackEnough) {
    std::vector<PlaceShare> result(triangles.size());
    forEachUneven(triangles.size(), 8, [&](std::size_t i) {
      const std::uint32_t t = triangles[i];
      const TrianglePlaces places(soup_, request_, t);
      const double share = 1.0 / static_cast<double>(places.count());
      for (std::size_t number = first; number < std::min(first + count, places.count()); ++number) {
        if (isBackEnough) {
          const float turns = turnsAt(sideOf(t, number, false), places.behind(number));
          result[i].least += share * std::clamp(static_cast<double>(turns), 0.0, 1.0);
        } else {
          const double closure = closureAt(places, t, number);
          result[i].least += share * closure, result[i].lost += share * (1.0 - closure);
        }
      }
    });
    return result;
  }

  /// Which triangles have open space on both sides at most of their places.
  std::vector<std::uint8_t> areOpen(const std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint8_t> result(triangles.size());
    forEachUneven(triangles.size(), 8, [&](std::size_t i) { result[i] = isOpen(triangles[i]); });
    return result;
  }

  SolidWinding takeClosed() { return std::move(closed_); } ///< the last that is asked of it

private:
  static constexpr std::size_t kStride = 7; // shares no factor with 4, 9 and 16 places

  /// The open triangles' winding number beside a place.
  struct Side {
    float turns = 0;
    std::uint32_t partsSeen = 0; ///< how many parts were counted
  };

  /// All open triangles count, later parts were taken out of them.
  float turnsAt(Side& side, glm::dvec3 point) const {
    for (; side.partsSeen < parts_.size(); ++side.partsSeen) {
      const auto turns = static_cast<float>(parts_[side.partsSeen].roughlyAt(point));
      side.turns += side.partsSeen == 0 ? turns : -turns;
    }
    return side.turns;
  }
  Side& sideOf(std::uint32_t triangle, std::size_t number, bool isBefore) {
    return sides_[2 * (firstPlace_[triangle] + number) + isBefore];
  }

  double closureAt(const TrianglePlaces& places, std::uint32_t triangle, std::size_t number) {
    const glm::dvec3 behind = places.behind(number), before = places.before(number);
    const float ofBehind = turnsAt(sideOf(triangle, number, false), behind);
    if (ofBehind >= 1.0f) return 1.0;
    const float most = std::max(ofBehind, turnsAt(sideOf(triangle, number, true), before));
    if (most < 1.0f && isInClosed(behind, before)) return 1.0;
    return std::clamp(static_cast<double>(most), 0.0, 1.0);
  }
  bool isOpenAt(const TrianglePlaces& places, std::uint32_t triangle, std::size_t number) {
    const glm::dvec3 behind = places.behind(number), before = places.before(number);
    return turnsAt(sideOf(triangle, number, false), behind) < 0.5f &&
           turnsAt(sideOf(triangle, number, true), before) < 0.5f && !isInClosed(behind, before);
  }
  bool isInClosed(glm::dvec3 behind, glm::dvec3 before) const {
    return closed_.isInside(behind) || closed_.isInside(before);
  }
  bool isOpen(std::uint32_t triangle) {
    const TrianglePlaces places(soup_, request_, triangle);
    const std::size_t count = places.count();
    std::size_t open = 0;
    for (std::size_t number = 0; number < count; ++number) {
      open += isOpenAt(places, triangle, number);
      if (2 * open > count || 2 * (open + count - number - 1) <= count) break;
    }
    return 2 * open > count;
  }

  const TriangleSoup& soup_;
  const SheetRequest& request_;
  SolidWinding closed_;
  std::vector<OpenWinding> parts_;        ///< all open triangles, then what was taken out
  std::vector<std::uint32_t> firstPlace_; ///< a triangle
  std::vector<Side> sides_;               ///< a place: behind, before
};

/// Sorts out the open triangles.
class ComponentSorter {
public:
  ComponentSorter(const TriangleSoup& soup, const MeshTopology& topology, const SheetRequest& request,
                  SheetJudge& judge)
      : soup_(soup), topology_(topology), request_(request), judge_(judge), components_(soup.triangles.size()) {}

  /// Adds to the result.
  void sort(std::vector<std::uint32_t> open, SolidsAndSheets& result) {
    for (int round = 0; round < kMostRounds; ++round) {
      add(open);
      std::vector<std::uint32_t> left, found;
      for (const std::uint32_t t : open) (componentOf(t).isSolid() ? left : found).push_back(t);
      open = std::move(left);
      if (found.empty()) break;
      judge_.remove(found, open);
      result.sheets.insert(result.sheets.end(), found.begin(), found.end());
    }
    std::vector<std::uint32_t> mayBeFlaps;
    for (const std::uint32_t t : open) (componentOf(t).isTwoSided() ? mayBeFlaps : result.solid).push_back(t);
    const std::vector<std::uint8_t> areOpen = judge_.areOpen(mayBeFlaps);
    for (std::size_t i = 0; i < mayBeFlaps.size(); ++i)
      componentOf(mayBeFlaps[i]).flapArea += areOpen[i] ? soup_.areaOf(mayBeFlaps[i]) : 0.0;
    for (std::size_t i = 0; i < mayBeFlaps.size(); ++i) {
      const Component& component = componentOf(mayBeFlaps[i]);
      const bool isFlap = areOpen[i] && component.flapArea > kLeastFlapShare * component.area;
      (isFlap ? result.sheets : result.solid).push_back(mayBeFlaps[i]);
    }
  }

private:
  struct Component {
    std::size_t triangleCount = 0, looked = 0;
    double area = 0, twoSidedArea = 0, flapArea = 0;
    double lookedArea = 0, lookedSquares = 0, closedArea = 0; ///< of the triangles that were looked at
    double mostClosedArea = 0; ///< what that may come to, while not all places were looked at
    bool isTwoSided() const { return twoSidedArea > 0.5 * area; }
    double leastClosure() const { return isTwoSided() ? kClosedTwoSided : kClosedOneSided; }
    bool isSolid() const { return closedArea >= leastClosure() * lookedArea; }
    bool isSure() const { return isSolid() || mostClosedArea < leastClosure() * lookedArea; }
    /// Of large components each n-th triangle is looked at first.
    std::size_t stride() const { return std::max<std::size_t>(1, triangleCount / kEnoughTriangles); }
    /// Whether what was seen is so far from the threshold that a look at more would not matter.
    bool isClear() const {
      const double off = std::abs(closedArea / lookedArea - leastClosure());
      return off >
             kClearDeviations * std::sqrt(lookedSquares) / lookedArea; // as of lookedArea^2 / lookedSquares places
    }
  };

  void add(const std::vector<std::uint32_t>& open) {
    for (const std::uint32_t t : open) componentOf(t) = {};
    for (const std::uint32_t t : open) {
      Component& component = componentOf(t);
      ++component.triangleCount;
      component.area += soup_.areaOf(t);
      component.twoSidedArea += request_.isDoubleSided[t] ? soup_.areaOf(t) : 0.0;
    }
    std::vector<std::uint32_t> first, rest;
    for (const std::uint32_t t : open) {
      Component& component = componentOf(t);
      (component.looked++ % component.stride() == 0 ? first : rest).push_back(t);
    }
    const auto isClear = [&](std::uint32_t t) { return componentOf(t).isClear(); };
    lookAt(first, true);
    std::erase_if(first, isClear);
    // Where all triangles were looked at, their mean decides alone.
    const auto middle =
        std::stable_partition(first.begin(), first.end(), [&](std::uint32_t t) { return componentOf(t).stride() > 1; });
    lookUntilSure({middle, first.end()});
    first.erase(middle, first.end());
    for (const std::uint32_t t : first)
      componentOf(t).lookedArea = componentOf(t).lookedSquares = componentOf(t).closedArea = 0;
    lookAt(first, false);
    std::erase_if(rest, isClear);
    lookAt(rest, false);
  }
  void lookAt(const std::vector<std::uint32_t>& triangles, bool isOneEnough) {
    const std::vector<double> closures = judge_.closures(triangles, isOneEnough);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      Component& component = componentOf(triangles[i]);
      const double area = soup_.areaOf(triangles[i]);
      component.lookedArea += area, component.lookedSquares += area * area;
      component.closedArea += area * closures[i];
    }
  }
  /// Looks at all places of whole components, place by place, until nothing that is left can change which side of the
  /// threshold they are on.
  void lookUntilSure(const std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint32_t> probablySolid, others;
    for (const std::uint32_t t : triangles) (componentOf(t).isSolid() ? probablySolid : others).push_back(t);
    lookUntilSure(probablySolid, true); // at backs alone: fronts can only add to them
    others.insert(others.end(), probablySolid.begin(), probablySolid.end());
    lookUntilSure(others, false);
  }
  /// triangles  those are left whose component is not sure yet
  void lookUntilSure(std::vector<std::uint32_t>& triangles, bool isBackEnough) {
    for (const std::uint32_t t : triangles) componentOf(t).lookedArea = componentOf(t).closedArea = 0;
    for (const std::uint32_t t : triangles) componentOf(t).lookedArea += soup_.areaOf(t);
    for (const std::uint32_t t : triangles) componentOf(t).mostClosedArea = componentOf(t).lookedArea;
    // Those that probably are solids take almost all of their places to be sure of.
    const std::size_t step = isBackEnough ? kMostPlacesPerSide : 1;
    for (std::size_t first = 0; first < kMostPlaces && !triangles.empty(); first += step) {
      const std::vector<SheetJudge::PlaceShare> shares = judge_.placeShares(triangles, first, step, isBackEnough);
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        Component& component = componentOf(triangles[i]);
        component.closedArea += soup_.areaOf(triangles[i]) * shares[i].least;
        component.mostClosedArea -= soup_.areaOf(triangles[i]) * shares[i].lost;
      }
      std::erase_if(triangles, [&](std::uint32_t t) { return componentOf(t).isSure(); });
    }
  }
  Component& componentOf(std::uint32_t triangle) { return components_[topology_.componentOf[triangle]]; }

  const TriangleSoup& soup_;
  const MeshTopology& topology_;
  const SheetRequest& request_;
  SheetJudge& judge_;
  std::vector<Component> components_; ///< by MeshTopology::componentOf
};

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

  std::unique_ptr<MeshHierarchy> closedHierarchy;
  if (!result.solid.empty()) closedHierarchy = std::make_unique<MeshHierarchy>(soup, result.solid);
  const std::size_t closedCount = result.solid.size();
  SolidWinding closed(soup, topology, result.solid, false, closedHierarchy.get());
  std::vector<std::uint32_t> looked = open;
  looked.insert(looked.end(), flatPairs.begin(), flatPairs.end());
  SheetJudge judge(soup, request, std::move(closed), open, looked);
  ComponentSorter(soup, topology, request, judge).sort(std::move(open), result);
  const std::vector<std::uint8_t> areOpen = judge.areOpen(flatPairs);
  for (std::size_t i = 0; i < flatPairs.size(); ++i)
    if (areOpen[i]) result.sheets.push_back(flatPairs[i]);
  if (result.solid.size() == closedCount && closedHierarchy) {
    result.solidHierarchy = std::move(closedHierarchy);
    result.solidWinding = judge.takeClosed();
  }
  std::sort(result.solid.begin(), result.solid.end());
  std::sort(result.sheets.begin(), result.sheets.end());
  return result;
}

} // namespace brickfield
