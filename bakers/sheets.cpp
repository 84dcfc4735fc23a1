// Winding numbers are taken a thickness behind the triangles and half of one before: a solid that is thinner than a
// slab could fall between the samples.
#include "bakers/sheets.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <tbb/parallel_for.h>

namespace brickfield {

namespace {

constexpr double kVoxelsPerPlace = 8; // a place stands for a brick's worth of triangle
constexpr int kMostPlacesPerSide = 4;
constexpr int kMostRounds = 64;

// Mean turn around the triangles from which an open component counts as a solid. Open scans, teapots and aeroplanes
// with windows cut out have 0.95 and more, a cube without a lid 0.90, half a sphere 0.80, a room of three walls 0.75,
// a pyramid without its base 0.57, a plane 1/2.
constexpr double kClosedTwoSided = 0.92;
constexpr double kClosedOneSided = 0.70;
constexpr std::size_t kEnoughTriangles =
    2048; // a mean over as many is off by 0.04 at most: four times 0.5 / sqrt(2048)
constexpr double kClearlyOff = 0.1;
constexpr double kLeastFlapShare = 0.02; // of a component's area; less is the rim of a spout or of a hole

/// What the places of a triangle saw.
struct TriangleLook {
  double closure = 0; ///< mean over the places: how far the side that is more inside is wrapped, 0 to 1
  bool isOpen = true; ///< open space on both sides at most places
};

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
                 [&](glm::dvec3 place) { visit(number++, place - 2.0 * toFront_, place + toFront_); });
  }

private:
  std::array<glm::dvec3, 3> corners_;
  int partsPerSide_ = 1;
  glm::dvec3 toFront_;
};

/// Looks at triangles by what is left of the open ones. The winding numbers at the places are kept, and brought up to
/// date by those of the triangles that were taken out since.
class SheetJudge {
public:
  SheetJudge(const TriangleSoup& soup, const SheetRequest& request, SolidWinding closed,
             const std::vector<std::uint32_t>& open)
      : soup_(soup),
        request_(request),
        closed_(std::move(closed)),
        firstPlace_(soup.triangles.size()),
        partsSeen_(soup.triangles.size(), 0) {
    std::uint32_t placeCount = 0;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      firstPlace_[t] = placeCount;
      placeCount += static_cast<std::uint32_t>(TrianglePlaces(soup, request, t).count());
    }
    windings_.assign(placeCount, glm::vec2(0.0f));
    if (!open.empty()) parts_.push_back(std::make_unique<Part>(soup, open));
  }

  /// Takes triangles out of the open ones.
  void remove(const std::vector<std::uint32_t>& triangles) {
    parts_.push_back(std::make_unique<Part>(soup_, triangles));
  }

  std::vector<TriangleLook> look(const std::vector<std::uint32_t>& triangles) {
    std::vector<TriangleLook> looks(triangles.size());
    tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t i) { looks[i] = lookAt(triangles[i]); });
    return looks;
  }

  SolidWinding takeClosed() { return std::move(closed_); } ///< the last that is asked of it

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

  TriangleLook lookAt(std::uint32_t triangle) {
    const TrianglePlaces places(soup_, request_, triangle);
    double closure = 0;
    std::size_t openPlaces = 0;
    places.forEach([&](std::size_t number, glm::dvec3 behind, glm::dvec3 before) {
      glm::vec2& winding = windings_[firstPlace_[triangle] + number];
      winding += glm::vec2(windingOf(partsSeen_[triangle], behind), windingOf(partsSeen_[triangle], before));
      float most = std::max(winding.x, winding.y);
      if (most < 1.0f && (closed_.excess(behind) >= 0 || closed_.excess(before) >= 0)) most = 1.0f;
      closure += std::clamp(static_cast<double>(most), 0.0, 1.0);
      openPlaces += most < 0.5f;
    });
    partsSeen_[triangle] = static_cast<std::uint32_t>(parts_.size());
    return {closure / static_cast<double>(places.count()), 2 * openPlaces > places.count()};
  }

  const TriangleSoup& soup_;
  const SheetRequest& request_;
  SolidWinding closed_;
  std::vector<std::unique_ptr<Part>> parts_; ///< all open triangles, then what was taken out
  std::vector<std::uint32_t> firstPlace_;    ///< a triangle
  std::vector<std::uint32_t> partsSeen_;     ///< a triangle: parts that its places have counted
  std::vector<glm::vec2> windings_;          ///< a place: of the open triangles, behind and before
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
      for (const std::uint32_t t : open) (isSolid(topology_.componentOf[t]) ? left : found).push_back(t);
      open = std::move(left);
      if (found.empty()) break;
      judge_.remove(found);
      result.sheets.insert(result.sheets.end(), found.begin(), found.end());
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Component& component = components_[topology_.componentOf[open[i]]];
      const bool isFlap =
          looks_[i].isOpen && component.isTwoSided() && component.flapArea > kLeastFlapShare * component.area;
      (isFlap ? result.sheets : result.solid).push_back(open[i]);
    }
  }

private:
  struct Component {
    std::size_t triangleCount = 0, looked = 0;
    double area = 0, twoSidedArea = 0;
    double lookedArea = 0, closedArea = 0, flapArea = 0; ///< of the triangles that were looked at
    bool isTwoSided() const { return twoSidedArea > 0.5 * area; }
    double leastClosure() const { return isTwoSided() ? kClosedTwoSided : kClosedOneSided; }
    /// Of large components each n-th triangle tells enough, but for flaps, which those of one side do not have.
    std::size_t stride() const { return isTwoSided() ? 1 : std::max<std::size_t>(1, triangleCount / kEnoughTriangles); }
    bool isClear() const { return stride() == 1 || std::abs(closedArea / lookedArea - leastClosure()) > kClearlyOff; }
  };

  void add(const std::vector<std::uint32_t>& open) {
    looks_.assign(open.size(), {});
    for (const std::uint32_t t : open) componentOf(t) = {};
    for (const std::uint32_t t : open) {
      Component& component = componentOf(t);
      ++component.triangleCount;
      component.area += soup_.areaOf(t);
      component.twoSidedArea += request_.isDoubleSided[t] ? soup_.areaOf(t) : 0.0;
    }
    std::vector<std::uint32_t> first, rest;
    for (std::uint32_t i = 0; i < open.size(); ++i) {
      Component& component = componentOf(open[i]);
      (component.looked++ % component.stride() == 0 ? first : rest).push_back(i);
    }
    lookAt(open, first);
    std::erase_if(rest, [&](std::uint32_t i) { return componentOf(open[i]).isClear(); });
    lookAt(open, rest);
  }
  /// numbers  into open
  void lookAt(const std::vector<std::uint32_t>& open, const std::vector<std::uint32_t>& numbers) {
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t i : numbers) triangles.push_back(open[i]);
    const std::vector<TriangleLook> looks = judge_.look(triangles);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      looks_[numbers[i]] = looks[i];
      Component& component = componentOf(triangles[i]);
      const double area = soup_.areaOf(triangles[i]);
      component.lookedArea += area;
      component.closedArea += area * looks[i].closure;
      component.flapArea += looks[i].isOpen ? area : 0.0;
    }
  }
  Component& componentOf(std::uint32_t triangle) { return components_[topology_.componentOf[triangle]]; }
  bool isSolid(std::uint32_t number) const {
    const Component& component = components_[number];
    return component.closedArea >= component.leastClosure() * component.lookedArea;
  }

  const TriangleSoup& soup_;
  const MeshTopology& topology_;
  const SheetRequest& request_;
  SheetJudge& judge_;
  std::vector<Component> components_; ///< by MeshTopology::componentOf
  std::vector<TriangleLook> looks_;   ///< of the last open triangles
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
  SheetJudge judge(soup, request, std::move(closed), open);
  ComponentSorter(soup, topology, request, judge).sort(std::move(open), result);
  const std::vector<TriangleLook> ofPairs = judge.look(flatPairs);
  for (std::size_t i = 0; i < flatPairs.size(); ++i)
    if (ofPairs[i].isOpen) result.sheets.push_back(flatPairs[i]);
  if (result.solid.size() == closedCount && closedHierarchy) {
    result.solidHierarchy = std::move(closedHierarchy);
    result.solidWinding = judge.takeClosed();
  }
  std::sort(result.solid.begin(), result.solid.end());
  std::sort(result.sheets.begin(), result.sheets.end());
  return result;
}

} // namespace brickfield
