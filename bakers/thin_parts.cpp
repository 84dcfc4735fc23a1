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
constexpr std::size_t kFirstPlaces = 1024; // a share that matters, 1 %, shows at ten of them
// A hit's normal reads samples up to a voxel from it, in cells that are sqrt(3) across.
constexpr float kGrownVoxels = 3.0f;
// An edge has no side: the closest point is drawn into its triangle.
constexpr double kOffEdgeVoxels = 1.0 / 16;
constexpr double kOffEdge = 1.0 / 256; // share of the way to the centroid: the first place would lie on an edge

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
    weights = glm::mix(weights, glm::dvec2(1.0 / 3), kOffEdge);
    const auto [a, b, c] = soup_.corners(triangle);
    return {triangle, a + weights.x * (b - a) + weights.y * (c - a)};
  }

private:
  const TriangleSoup& soup_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> areasUpTo_;
};

/// Moves of the surface that is closest to samples of a level.
class SolidGrowth {
public:
  SolidGrowth(const SolidThickness& thickness, const LevelSamples& level, const LargeVector<std::uint8_t>& sampleInside)
      : thickness_(thickness), level_(level), sampleInside_(sampleInside) {}

  /// slot  of the sample in the level's arrays
  double voxelsAt(std::size_t slot, glm::dvec3 sample) const {
    const std::uint32_t triangle = level_.solidTriangles[slot];
    const bool isInside = sampleInside_[slot] != 0;
    const double voxelSize = level_.grid.voxelSize;
    const auto corners = thickness_.soup().corners(triangle);
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
    const bool isBefore = known.before ? *known.before : known.behind && !*known.behind;
    if (isThickTowards(place, isBefore ? normal : -normal)) return 0.0;
    const double behind = thickness_.behind(triangle, place, limit, known).value_or(limit);
    return std::clamp(0.5 * (limit - behind) / voxelSize, 0.0, kMostGrowthVoxels);
  }

private:
  /// True where samples' balls tell that the solid goes on half the limit from a place and the whole limit: it is thick
  /// there, whatever is on the other side.
  bool isThickTowards(glm::dvec3 place, glm::dvec3 direction) const {
    const double limit = kSmoothSolidVoxels * level_.grid.voxelSize;
    return isInBallInside(place + 0.5 * limit * direction) && isInBallInside(place + limit * direction);
  }

  /// Whether a point lies in the empty ball around one of the eight samples about it, and that sample inside.
  bool isInBallInside(glm::dvec3 point) const {
    const glm::dvec3 place = (point - level_.grid.origin) / level_.grid.voxelSize;
    const glm::ivec3 low = glm::ivec3(glm::floor(place)), last = kBrickCells * level_.grid.brickCounts;
    if (glm::any(glm::lessThan(low, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(low, last))) return false;
    const glm::ivec3 brick = low / kBrickCells;
    const std::uint32_t b = level_.brickOfCell[level_.grid.cellOfBrick(brick)];
    if (b == kNoBrick) return false;
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 sample = low + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
      const std::size_t slot = std::size_t{b} * kBrickSampleCount + sampleIndex(sample - kBrickCells * brick);
      if (glm::length(place - glm::dvec3(sample)) < kBallShare * static_cast<double>(level_.solidDistances[slot]))
        return sampleInside_[slot] != 0;
    }
    return false;
  }

  static constexpr double kBallShare = 1 - 1e-3; // over the rounding of distances to float

  const SolidThickness& thickness_;
  const LevelSamples& level_;
  const LargeVector<std::uint8_t>& sampleInside_;
};

} // namespace

ThinParts findThinParts(const SolidThickness& thickness, double voxelSize, int resolution) {
  const ClosedSurface surface(thickness);
  if (surface.isEmpty()) return {};
  std::vector<std::optional<double>> thicknesses(kPlaces);
  const auto look = [&](std::size_t begin, std::size_t end) {
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      const Place place = surface.place(i);
      thicknesses[i] = thickness.behind(place.triangle, place.point, voxelSize);
    });
    return std::any_of(thicknesses.begin(), thicknesses.begin() + static_cast<std::ptrdiff_t>(end),
                       [](const std::optional<double>& found) { return found && *found < HUGE_VAL; });
  };
  if (!look(0, kFirstPlaces)) return {};
  look(kFirstPlaces, kPlaces);
  std::vector<double> seen;
  for (const std::optional<double>& voxels : thicknesses)
    if (voxels) seen.push_back(*voxels / voxelSize);
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

LargeVector<float> growThinSolids(const SolidThickness& thickness, const SamplingRequest& request,
                                  const LevelSamples& level, const LargeVector<std::uint8_t>& sampleInside) {
  LargeVector<float> growth(level.solidDistances.size(), 0.0f);
  const SolidGrowth solid(thickness, level, sampleInside);
  tbb::parallel_for(std::size_t{0}, level.brickCount(), [&](std::size_t b) {
    request.done(0);
    const glm::ivec3 brick = level.grid.brickOfCell(level.cellOfBrick[b]);
    for (std::size_t i = 0; i < kBrickSampleCount; ++i) {
      const std::size_t slot = b * kBrickSampleCount + i;
      const std::uint32_t triangle = level.solidTriangles[slot];
      if (level.solidDistances[slot] > kGrownVoxels || !thickness.isClosed(triangle)) continue;
      growth[slot] = static_cast<float>(solid.voxelsAt(slot, level.grid.sample(brick, sampleOfIndex(i))));
    }
  });
  return growth;
}

} // namespace brickfield
