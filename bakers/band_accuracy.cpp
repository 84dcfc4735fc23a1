// Solid angles by Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983.
#include "bakers/band_accuracy.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include <tbb/parallel_for.h>

#include "bakers/mesh_distance.h"
#include "field/brick_layout.h"

namespace brickfield {

namespace {

constexpr double kOnSurfaceVoxels = 1e-4; // nearer points have no side

struct PointTruth {
  double distance = std::numeric_limits<double>::infinity(); ///< soup space
  double turns = 0;
};

PointTruth truthAt(const TriangleSoup& soup, glm::dvec3 point) {
  PointTruth truth;
  double angle = 0;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const std::array<glm::dvec3, 3> corners = soup.corners(t);
    truth.distance = std::min(truth.distance, glm::length(point - closestPointOnTriangle(point, corners).point));
    const glm::dvec3 a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  truth.turns = angle / (4 * std::numbers::pi);
  return truth;
}

/// One sample of a band.
struct Compared {
  double error = 0, codedError = 0;
  bool isSignWrong = false;
  double turnsFromHalf = 0;
};

class BandComparison {
public:
  explicit BandComparison(const BandBake& band) : band_(band), cellOfBrick_(band.level.brickCount()) {
    for (std::size_t cell = 0; cell < band.level.indirection.size(); ++cell)
      if (const IndirectionCell content{band.level.indirection[cell]}; !content.isEmpty())
        cellOfBrick_[content.brickIndex()] = cell;
  }

  Compared at(std::size_t number) const {
    const std::size_t brick = number / kBrickSampleCount, index = number % kBrickSampleCount;
    const auto i = static_cast<int>(index);
    const glm::ivec3 sample(i % kBrickSamples, i / kBrickSamples % kBrickSamples, i / (kBrickSamples * kBrickSamples));
    const BrickLevel& level = band_.level;
    const double voxel = level.voxelSizeObject, range = level.rangeVoxels;
    const glm::dvec3 point =
        glm::dvec3(band_.originObject) + voxel * glm::dvec3(kBrickCells * brickAt(cellOfBrick_[brick]) + sample);
    const PointTruth truth = truthAt(band_.soup, band_.soup.soupFromObject(point));
    const double distance = truth.distance / band_.soup.unitsPerMetre / voxel;
    const double baked = band_.signedVoxels[number];
    const double coded = storedDistance(level, static_cast<std::uint32_t>(brick), sample);
    Compared result;
    result.error = std::abs(std::min(std::abs(baked), range) - std::min(distance, range));
    result.codedError = std::abs(std::abs(coded) - std::min(distance, range));
    result.isSignWrong = distance > kOnSurfaceVoxels && (baked < 0) != (std::abs(truth.turns) >= 0.5);
    result.turnsFromHalf = std::abs(std::abs(truth.turns) - 0.5);
    return result;
  }

private:
  glm::ivec3 brickAt(std::size_t cell) const {
    const auto x = static_cast<std::size_t>(band_.level.brickCounts.x);
    const auto y = static_cast<std::size_t>(band_.level.brickCounts.y);
    return {cell % x, cell / x % y, cell / (x * y)};
  }

  const BandBake& band_;
  std::vector<std::size_t> cellOfBrick_;
};

} // namespace

BandAccuracy measureBand(const BandBake& band, std::size_t samples) {
  const std::size_t all = band.signedVoxels.size(), count = std::min(samples, all);
  BandAccuracy result;
  result.samples = count;
  result.quantum = band.level.rangeVoxels / (band.level.format == DistanceFormat::R8Snorm ? 127.0 : 32767.0);
  const BandComparison comparison(band);
  std::mutex mutex;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    // A step that shares no factor with the sides of bricks: places in them differ.
    const Compared compared = comparison.at((i * all / count + 37 * i) % all);
    const std::lock_guard lock(mutex);
    result.largestError = std::max(result.largestError, compared.error);
    result.largestCodedError = std::max(result.largestCodedError, compared.codedError);
    result.wrongSigns += compared.isSignWrong;
    if (compared.isSignWrong) result.farthestTurns = std::max(result.farthestTurns, compared.turnsFromHalf);
  });
  return result;
}

} // namespace brickfield
