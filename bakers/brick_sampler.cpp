// Walks start with a bound: a sample is at most a voxel farther from the surface than the one beside it. Walks end at
// the range: what lies beyond is clamped anyway, and the flood of signs only asks whether two neighbours are farther
// from the surface than from each other.
#include "bakers/brick_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "bakers/block_distance.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr float kUnknown = std::numeric_limits<float>::infinity();
constexpr float kOnSurfaceVoxels = 2e-6f;  // above the error of a block
constexpr float kBoundSlackVoxels = 1e-4f; // over the rounding of distances in voxels to float

bool isWanted(const SampleRows& wanted, std::size_t i) { return wanted[i / kBrickSamples] >> (i % kBrickSamples) & 1; }

/// Calls visit(sample) for those that are wanted, ascending; most rows are whole.
template <typename Visit>
void forEachWanted(const SampleRows& wanted, const Visit& visit) {
  for (std::size_t row = 0; row < wanted.size(); ++row) {
    if (wanted[row] == 0xff)
      for (std::size_t i = 0; i < kBrickSamples; ++i) visit(kBrickSamples * row + i);
    else
      for (unsigned rest = wanted[row]; rest != 0; rest &= rest - 1)
        visit(kBrickSamples * row + static_cast<std::size_t>(std::countr_zero(rest)));
  }
}

/// Samples on the surface are at zero whichever way the triangle turns and whatever was rounded.
float onOrOff(float voxels) { return voxels < kOnSurfaceVoxels ? 0.0f : voxels; }

/// Least of the distances, in voxels, of the samples before one along each axis.
float leastBefore(const std::array<float, kSamples>& found, int x, int y, int z) {
  const std::size_t i = sampleIndex({x, y, z});
  float least = kUnknown;
  if (x > 0) least = std::min(least, found[i - 1]);
  if (y > 0) least = std::min(least, found[i - kBrickSamples]);
  if (z > 0) least = std::min(least, found[i - kBrickSamples * kBrickSamples]);
  return least;
}

} // namespace

void SurfaceSampler::run(glm::ivec3 brick, const SampleRows& wanted, float* distances, std::uint32_t* triangles) const {
  if (isCapped && runBlock(brick, wanted, distances, triangles)) return;
  runWalks(brick, wanted, distances, triangles);
}

double SurfaceSampler::capVoxels() const {
  return kSampledRangeVoxels + (slabs ? slabs->mostReach(halfThickness) / grid.voxelSize : 0.0);
}

/// Voxels of what was found, or the range.
float SurfaceSampler::finish(glm::dvec3 point, NearestTriangle nearest) const {
  if (nearest.triangle == kNoTriangle) return static_cast<float>(kSampledRangeVoxels);
  if (!slabs) return onOrOff(static_cast<float>(nearest.distance / grid.voxelSize));
  const PointOnTriangle on = closestPointOnTriangle(point, surface.hierarchy().soup().corners(nearest.triangle));
  const ClosestTriangle closest{glm::length(point - on.point), nearest.triangle, on};
  return static_cast<float>(slabs->distance(point, closest, halfThickness) / grid.voxelSize);
}

/// A brick out of reach of all triangles. The first sample names one if that is asked for.
void SurfaceSampler::runFar(glm::ivec3 brick, const SampleRows& wanted, float* distances,
                            std::uint32_t* triangles) const {
  const auto row = static_cast<std::size_t>(
      std::find_if(wanted.begin(), wanted.end(), [](std::uint8_t samples) { return samples != 0; }) - wanted.begin());
  std::fill_n(distances, kSamples, static_cast<float>(kSampledRangeVoxels));
  if (row == wanted.size() || !triangles) return;
  const std::size_t first = kBrickSamples * row + static_cast<std::size_t>(std::countr_zero(wanted[row]));
  const NearestTriangle nearest = surface.nearest(grid.sample(brick, sampleOfIndex(first)));
  std::fill_n(triangles, kSamples, nearest.triangle);
}

/// returns false where there are too many triangles
bool SurfaceSampler::runBlock(glm::ivec3 brick, const SampleRows& wanted, float* distances,
                              std::uint32_t* triangles) const {
  std::array<std::uint32_t, kMostBlockTriangles> near;
  const double halfEdge = 0.5 * kBrickCells * grid.voxelSize;
  const std::size_t count = surface.collect({grid.brickCenter(brick), halfEdge, capVoxels() * grid.voxelSize}, near);
  if (count > near.size()) return false;
  if (count == 0) {
    runFar(brick, wanted, distances, triangles);
    return true;
  }
  std::sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count));
  std::array<float, kSamples> found, heights;
  std::array<std::uint32_t, kSamples> nearest;
  BlockHeights heightsOf(heights);
  const std::span<const std::uint32_t> around(near.data(), count);
  const SampleBlock block{grid.brickCenter(brick), grid.voxelSize};
  BlockTriangles nearestOf(nearest);
  const bool areCentred = slabs && slabs->areAllCentred();
  const bool areAlike = !slabs || (areCentred && !slabs->hasPieces()); // whichever triangle is closest
  blockDistances({&surface.hierarchy().soup(), around, block, wanted, static_cast<float>(capVoxels())}, found,
                 triangles || !areAlike ? &nearestOf : nullptr, slabs && !areCentred ? &heightsOf : nullptr);
  const double halfVoxels = halfThickness / grid.voxelSize;
  std::uint32_t last = near[0];
  for (std::size_t i = 0; triangles && i < kSamples; ++i) {
    last = nearest[i] != kNoTriangle ? nearest[i] : last;
    triangles[i] = last;
  }
  if (!slabs || areCentred) { // samples that nothing is near are infinitely far here
    if (slabs)
      slabs->centreDistances(found, areAlike ? nullptr : nearest.data(), halfVoxels);
    else
      for (float& voxels : found) voxels = onOrOff(voxels);
    const auto range = static_cast<float>(kSampledRangeVoxels);
    for (std::size_t i = 0; i < kSamples; ++i) distances[i] = found[i] < range ? found[i] : range;
    return true;
  }
  forEachWanted(wanted, [&](std::size_t i) {
    if (nearest[i] == kNoTriangle)
      distances[i] = static_cast<float>(kSampledRangeVoxels);
    else if (!slabs->isBehind(nearest[i]))
      distances[i] = static_cast<float>(slabs->centredDistance(nearest[i], static_cast<double>(found[i]), halfVoxels));
    else if (std::isfinite(heights[i]))
      distances[i] = static_cast<float>(slabs->distanceOver(nearest[i], static_cast<double>(heights[i]), halfVoxels));
    else
      distances[i] = finish(grid.sample(brick, sampleOfIndex(i)), {0.0, nearest[i]});
  });
  return true;
}

void SurfaceSampler::runWalks(glm::ivec3 brick, const SampleRows& wanted, float* distances,
                              std::uint32_t* triangles) const {
  const double cap = capVoxels() * grid.voxelSize;
  const LocalRoots roots = surface.rootsAround({grid.brickCenter(brick), 0.5 * kBrickCells * grid.voxelSize, cap});
  std::array<float, kSamples> found;
  found.fill(kUnknown);
  std::uint32_t last = kNoTriangle, start = kNoLeaf;
  for (std::size_t i = 0; i < kSamples; ++i) {
    if (!isWanted(wanted, i)) continue;
    const glm::ivec3 index = sampleOfIndex(i);
    const glm::dvec3 point = grid.sample(brick, index);
    // Where triangles are to be named the very first is not capped, so that there always is one.
    double limit = isCapped && (last != kNoTriangle || !triangles) ? cap : HUGE_VAL;
    const float before = leastBefore(found, index.x, index.y, index.z);
    limit = std::min(limit, static_cast<double>(before + 1.0f + kBoundSlackVoxels) * grid.voxelSize);
    const NearestTriangle nearest =
        limit <= cap ? surface.nearest(roots, point, limit, start) : surface.nearest(point, limit, start);
    if (nearest.triangle != kNoTriangle) {
      last = nearest.triangle, start = nearest.leaf;
      found[i] = static_cast<float>(nearest.distance / grid.voxelSize);
    }
    if (triangles) triangles[i] = last;
    distances[i] = finish(point, nearest);
    if (isCapped) distances[i] = std::min(distances[i], static_cast<float>(kSampledRangeVoxels));
  }
}

} // namespace brickfield
