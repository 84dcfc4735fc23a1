// Places by Roberts' two-dimensional low-discrepancy sequence on the unrolled surface: area along one axis, position in
// the triangle by both.
#include "bakers/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

namespace brickfield {

namespace {

constexpr std::size_t kPlaces = 4096;
constexpr int kSteps = 12; // from 1/64 voxel to a whole one
constexpr double kLeastVoxels = 1.0 / 64;
constexpr double kProbeVoxels = 1.0 / 128; // where the sides of a place are looked at
constexpr double kBallSlack = 1e-3;        // over rounding, and curvature within half a voxel that hides nothing
constexpr double kThick = HUGE_VAL;

struct Place {
  glm::dvec3 point{0.0}, normal{0.0}; ///< soup space; unit
  std::uint32_t triangle = kNoTriangle;
};

/// Triangles that bound closed solids, with the sums of their areas.
class ClosedSurface {
public:
  explicit ClosedSurface(const ThinPartsRequest& request) : soup_(*request.soup) {
    double area = 0;
    for (std::uint32_t t = 0; t < soup_.firstPiece(); ++t) {
      if (!request.topology->inClosedComponent[t] || request.topology->isFlatPair[t]) continue;
      triangles_.push_back(t);
      areasUpTo_.push_back(area += soup_.areaOf(t));
    }
  }
  bool isEmpty() const { return triangles_.empty(); }

  Place place(std::size_t number) const {
    // Powers of the reciprocal of the plastic number (root of x^3 = x + 1), and of the golden ratio for what is left.
    const auto fraction = [&](double step) { return std::fmod(0.5 + step * static_cast<double>(number), 1.0); };
    const double area = fraction(0.61803398874989485) * areasUpTo_.back();
    const auto found = std::upper_bound(areasUpTo_.begin(), areasUpTo_.end() - 1, area) - areasUpTo_.begin();
    Place place;
    place.triangle = triangles_[static_cast<std::size_t>(found)];
    glm::dvec2 weights(fraction(0.75487766624669276), fraction(0.56984029099805327));
    if (weights.x + weights.y > 1) weights = 1.0 - weights;
    const auto [a, b, c] = soup_.corners(place.triangle);
    place.point = a + weights.x * (b - a) + weights.y * (c - a);
    place.normal = glm::normalize(glm::cross(b - a, c - a));
    return place;
  }

private:
  const TriangleSoup& soup_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> areasUpTo_;
};

/// Voxels of solid behind a place: kThick for more than one; nothing where no surface is seen, inside of something
/// else.
std::optional<double> thicknessAt(const ThinPartsRequest& request, const Place& place) {
  const auto isInside = [&](double voxels) {
    return request.inside->isInside(place.point + voxels * request.voxelSize * place.normal);
  };
  const bool before = isInside(kProbeVoxels), behind = isInside(-kProbeVoxels);
  if (before && behind) return std::nullopt;
  if (!before && !behind) return kProbeVoxels; // it ends already: across a closed surface the sides differ
  const double inwards = behind ? -1.0 : 1.0;
  const double radius = 0.5 * request.voxelSize;
  const glm::dvec3 center = place.point + inwards * radius * place.normal;
  if (request.solid->closest(center, (1 - kBallSlack) * radius).triangle == kNoTriangle) return kThick;
  double last = kProbeVoxels;
  for (int step = 0; step <= kSteps; ++step) {
    const double next = kLeastVoxels * std::exp2(0.5 * step);
    if (!isInside(inwards * next)) return last;
    last = next;
  }
  return kThick;
}

} // namespace

ThinParts findThinParts(const ThinPartsRequest& request) {
  const ClosedSurface surface(request);
  if (surface.isEmpty()) return {};
  std::vector<std::optional<double>> thicknesses(kPlaces);
  tbb::parallel_for(std::size_t{0}, kPlaces,
                    [&](std::size_t i) { thicknesses[i] = thicknessAt(request, surface.place(i)); });
  std::vector<double> seen;
  for (const std::optional<double>& thickness : thicknesses)
    if (thickness) seen.push_back(*thickness);
  if (seen.empty()) return {};
  std::sort(seen.begin(), seen.end());
  const auto count = static_cast<double>(seen.size());
  const auto thin = static_cast<double>(std::lower_bound(seen.begin(), seen.end(), kThick) - seen.begin());
  ThinParts result;
  result.perTenThousand = static_cast<std::uint16_t>(std::lround(thin / count * ThinParts::kWhole));
  const double least = seen[static_cast<std::size_t>(kThinShareAllowed * count)];
  if (least < kThick)
    result.resolution = static_cast<std::uint16_t>(std::min(std::ceil(request.resolution / least), 65535.0));
  return result;
}

} // namespace brickfield
