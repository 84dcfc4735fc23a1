// Places by Roberts' two-dimensional low-discrepancy sequence on the unrolled surface: area by the golden ratio,
// position in the triangle by the plastic number.
#include "bakers/thin_parts.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bakers/patch_graph.h"

namespace brickfield {

namespace {

constexpr std::size_t kPlaces = 4096;
// A hit's normal reads samples up to a voxel from it, in cells that are sqrt(3) across.
constexpr float kGrownVoxels = 3.0f;
// An edge has no side: the closest point is drawn into its triangle.
constexpr double kOffEdgeVoxels = 1.0 / 16;

struct Place {
  std::uint32_t triangle = kNoTriangle;
  glm::dvec3 point{0.0}; ///< soup space
};

constexpr double kOverFace = 0.9;              // cosine
constexpr double kOffSurfaceVoxels = 1.0 / 64; // a sample on the surface has no side

/// Triangles that bound closed solids, with the sums of their areas.
class ClosedSurface {
public:
  explicit ClosedSurface(const SolidThickness& thickness) : soup_(thickness.soup()) {
    double area = 0;
    for (std::uint32_t t = 0; t < soup_.firstPiece(); ++t) {
      if (!thickness.isClosed(t)) continue;
      triangles_.push_back(t);
      areasUpTo_.push_back(area += soup_.areaOf(t));
    }
  }
  bool isEmpty() const { return triangles_.empty(); }

  Place place(std::size_t number) const {
    const auto fraction = [&](double step) { return std::fmod(0.5 + step * static_cast<double>(number), 1.0); };
    const double area = fraction(0.61803398874989485) * areasUpTo_.back();
    const auto found = std::upper_bound(areasUpTo_.begin(), areasUpTo_.end() - 1, area) - areasUpTo_.begin();
    const std::uint32_t triangle = triangles_[static_cast<std::size_t>(found)];
    glm::dvec2 weights(fraction(0.75487766624669276), fraction(0.56984029099805327));
    if (weights.x + weights.y > 1) weights = 1.0 - weights;
    const auto [a, b, c] = soup_.corners(triangle);
    return {triangle, a + weights.x * (b - a) + weights.y * (c - a)};
  }

private:
  const TriangleSoup& soup_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> areasUpTo_;
};

double growthVoxels(const SolidThickness& thickness, std::uint32_t triangle, glm::dvec3 sample, bool isInside,
                    double voxelSize) {
  const auto corners = thickness.soup().corners(triangle);
  const glm::dvec3 on = closestPointOnTriangle(sample, corners).point;
  const glm::dvec3 toCentroid = (corners[0] + corners[1] + corners[2]) / 3.0 - on;
  const double far = glm::length(toCentroid), step = kOffEdgeVoxels * voxelSize;
  const glm::dvec3 place = on + (far > step ? step / far : 1.0) * toCentroid;
  const double limit = kSmoothSolidVoxels * voxelSize;
  // Where the sample stands over the triangle's face rather than beyond its edge, its side is the face's.
  const glm::dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double height = glm::dot(sample - on, normal);
  const double over = std::max(kOverFace * glm::length(sample - on), kOffSurfaceVoxels * voxelSize);
  KnownSides known;
  known.emptyCenter = sample, known.emptyRadius = glm::length(sample - on);
  if (height > over) known.before = isInside;
  if (height < -over) known.behind = isInside;
  const double behind = thickness.behind(triangle, place, limit, known).value_or(limit);
  return std::clamp(0.5 * (limit - behind) / voxelSize, 0.0, kMostGrowthVoxels);
}

} // namespace

ThinParts findThinParts(const SolidThickness& thickness, double voxelSize, int resolution) {
  const ClosedSurface surface(thickness);
  if (surface.isEmpty()) return {};
  std::vector<std::optional<double>> thicknesses(kPlaces);
  tbb::parallel_for(std::size_t{0}, kPlaces, [&](std::size_t i) {
    const Place place = surface.place(i);
    thicknesses[i] = thickness.behind(place.triangle, place.point, voxelSize);
  });
  std::vector<double> seen;
  for (const std::optional<double>& voxels : thicknesses)
    if (voxels) seen.push_back(*voxels / voxelSize);
  if (seen.empty()) return {};
  std::sort(seen.begin(), seen.end());
  const auto count = static_cast<double>(seen.size());
  const auto thin = static_cast<double>(std::lower_bound(seen.begin(), seen.end(), HUGE_VAL) - seen.begin());
  ThinParts result;
  result.perTenThousand = static_cast<std::uint16_t>(std::lround(thin / count * ThinParts::kWhole));
  const double least = seen[static_cast<std::size_t>(kThinShareAllowed * count)];
  if (least < HUGE_VAL)
    result.resolution = static_cast<std::uint16_t>(std::min(std::ceil(resolution / least), 65535.0));
  return result;
}

std::vector<float> growThinSolids(const SolidThickness& thickness, const SamplingRequest& request,
                                  const LevelSamples& level, const std::vector<std::uint8_t>& sampleInside) {
  std::vector<float> growth(level.solidDistances.size());
  tbb::parallel_for(std::size_t{0}, level.brickCount(), [&](std::size_t b) {
    request.done(0);
    const glm::ivec3 brick = level.grid.brickOfCell(level.cellOfBrick[b]);
    for (std::size_t i = 0; i < kBrickSampleCount; ++i) {
      const std::size_t slot = b * kBrickSampleCount + i;
      const std::uint32_t triangle = level.solidTriangles[slot];
      if (level.solidDistances[slot] > kGrownVoxels || !thickness.isClosed(triangle)) continue;
      const glm::dvec3 sample = level.grid.sample(brick, sampleOfIndex(i));
      growth[slot] =
          static_cast<float>(growthVoxels(thickness, triangle, sample, sampleInside[slot] != 0, level.grid.voxelSize));
    }
  });
  return growth;
}

} // namespace brickfield
