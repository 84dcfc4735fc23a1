// One look at each of some samples; the flood that decided the signs in bulk is not asked.
#include "bakers/sign_census.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bakers/inside_test.h"
#include "bakers/level_sampler.h"

namespace brickfield {

namespace {

constexpr double kDoubtfulBelow = 0.2;
constexpr double kUnjudgedVoxels = 1e-3; // so near, a sample lies on the surface

struct Vote {
  bool isSheet = false, isOpen = false, isOverruled = false;
  float sureness = 1;
};

struct StoredSample {
  glm::ivec3 brick{0}, sample{0};
  std::uint32_t brickIndex = 0;
};

std::vector<StoredSample> thinnedSamples(const BrickLevel& level, std::uint64_t mostSamples) {
  const std::uint64_t all = std::uint64_t{level.brickCount()} * kBrickSampleCount;
  const std::uint64_t stride = (all + mostSamples - 1) / mostSamples | 1; // odd: never stuck in one column
  std::vector<StoredSample> samples;
  std::uint64_t number = 0;
  for (int z = 0; z < level.brickCounts.z; ++z)
    for (int y = 0; y < level.brickCounts.y; ++y)
      for (int x = 0; x < level.brickCounts.x; ++x) {
        const IndirectionCell cell{level.indirection[level.cellIndex({x, y, z})]};
        if (cell.isEmpty()) continue;
        for (int i = 0; i < kBrickSampleCount; ++i)
          if (number++ % stride == 0) samples.push_back({{x, y, z}, {i % 8, i / 8 % 8, i / 64}, cell.brickIndex()});
      }
  return samples;
}

} // namespace

SignCensus countSigns(const TriangleSoup& soup, const BakeSurfaces& surfaces, const InsideTest* inside,
                      const BrickField& field, std::uint64_t mostSamples) {
  const BrickLevel& level = field.levels.front();
  const std::vector<StoredSample> samples = thinnedSamples(level, mostSamples);
  std::vector<Vote> votes(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    const auto& [brick, sample, brickIndex] = samples[i];
    const glm::dvec3 point = soup.soupFromObject(
        glm::dvec3(field.originObject) + double{level.voxelSizeObject} * glm::dvec3(kBrickCells * brick + sample));
    Vote& vote = votes[i];
    const double toSheet = surfaces.sheets ? surfaces.sheets->closest(point).distance : HUGE_VAL;
    const double toSolid = inside ? surfaces.solid->closest(point, toSheet).distance : HUGE_VAL;
    vote.isSheet = !inside || toSolid > toSheet;
    if (vote.isSheet) return;
    const double excess = inside->excess(point);
    vote.isOpen = std::isfinite(excess);
    if (vote.isOpen) vote.sureness = static_cast<float>(std::min(1.0, 2 * std::abs(excess)));
    const bool isJudged = toSolid > kUnjudgedVoxels * level.voxelSizeObject * soup.unitsPerMetre;
    vote.isOverruled = isJudged && (storedDistance(level, brickIndex, sample) < 0) != (excess >= 0);
  });

  SignCensus census;
  census.samples = votes.size();
  if (votes.empty()) return census;
  const double one = 1.0 / static_cast<double>(votes.size());
  std::vector<float> sureness;
  double sum = 0;
  for (const Vote& vote : votes) {
    (vote.isSheet ? census.bySheets : vote.isOpen ? census.byOpen : census.byClosed) += one;
    census.overruled += vote.isOverruled ? one : 0;
    if (!vote.isOpen || vote.isSheet) continue;
    sureness.push_back(vote.sureness);
    sum += vote.sureness;
    census.doubtful += vote.sureness < kDoubtfulBelow ? one : 0;
  }
  if (sureness.empty()) return census;
  std::sort(sureness.begin(), sureness.end());
  census.meanSureness = sum / static_cast<double>(sureness.size());
  census.leastSureness = sureness[sureness.size() / 100];
  return census;
}

} // namespace brickfield
