// The surface of a sample is what bounds it: the union of solids and slabs, min(signed solid distance, slab distance).
#include "bakers/level_baker.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "bakers/each_uneven.h"
#include "bakers/float4.h"
#include "bakers/membranes.h"
#include "bakers/patch_graph.h"
#include "bakers/stage_clock.h"
#include "bakers/thin_parts.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr float kAttributeVoxels =
    2.0f;                           // trilinear reads reach sqrt(3) voxels from a hit; the rest is for hits off zero
constexpr double kCoatVoxels = 1.0; // coats thicker than this have samples of their own
constexpr double kCoatSlackVoxels = 1e-3; // layers nearer than this count as one

using BrickVoxels = std::span<const float, kSamples>; ///< signed distances

/// Signed distances in voxels and the triangles that they come from, in the place of the solids' (or sheets') own
/// arrays.
struct SignedSamples {
  LargeVector<float> distances;
  LargeVector<std::uint32_t> triangles;
  LargeVector<std::uint8_t> isSheet; ///< 1 where the distance is a slab's; if triangles are kept
};

/// Makes one of solids and sheets, brick by brick.
class SampleUnion {
public:
  /// level   its arrays are taken
  /// growth  a sample, in voxels: how far solids are moved outwards; empty: nowhere
  SampleUnion(LevelSamples& level, const LargeVector<std::uint8_t>& sampleInside, const LargeVector<float>& growth)
      : sampleInside_(sampleInside), growth_(growth), hasSolids_(!level.solidDistances.empty()) {
    if (!hasSolids_) {
      result_.isSheet.assign(level.sheetTriangles.size(), 1);
      result_.distances = std::move(level.sheetDistances), result_.triangles = std::move(level.sheetTriangles);
      return;
    }
    result_.isSheet.assign(level.solidTriangles.size(), 0);
    result_.distances = std::move(level.solidDistances), result_.triangles = std::move(level.solidTriangles);
    sheetDistances_ = std::move(level.sheetDistances), sheetTriangles_ = std::move(level.sheetTriangles);
  }

  /// Once for each brick, from any thread. A loop for each step, without branches.
  BrickVoxels unite(std::size_t b) {
    const std::size_t begin = b * kSamples;
    float* distances = &result_.distances[begin];
    if (!hasSolids_) return BrickVoxels(distances, kSamples);
    const std::uint8_t* inside = &sampleInside_[begin];
    for (std::size_t i = 0; i < kSamples; ++i) distances[i] = inside[i] ? -distances[i] : distances[i];
    if (!growth_.empty())
      for (std::size_t i = 0; i < kSamples; ++i) distances[i] -= growth_[begin + i];
    if (!sheetDistances_.empty()) addSheets(begin);
    return BrickVoxels(distances, kSamples);
  }
  SignedSamples take() { return std::move(result_); }

private:
  void addSheets(std::size_t begin) {
    float* distances = &result_.distances[begin];
    const float* sheetDistances = &sheetDistances_[begin];
    const float leastSheet = leastOf(sheetDistances, kSamples, [](Float4 v) { return v; });
    const float mostSolid = -leastOf(distances, kSamples, [](Float4 v) { return -v; });
    if (leastSheet >= mostSolid) return;
    if (!sheetTriangles_.empty()) {
      const std::uint32_t* sheetTriangles = &sheetTriangles_[begin];
      std::uint32_t* triangles = &result_.triangles[begin];
      std::uint8_t* isSheet = &result_.isSheet[begin];
      for (std::size_t i = 0; i < kSamples; ++i) isSheet[i] = sheetDistances[i] < distances[i];
      for (std::size_t i = 0; i < kSamples; ++i)
        triangles[i] = sheetDistances[i] < distances[i] ? sheetTriangles[i] : triangles[i];
    }
    for (std::size_t i = 0; i < kSamples; ++i)
      distances[i] = sheetDistances[i] < distances[i] ? sheetDistances[i] : distances[i];
  }

  const LargeVector<std::uint8_t>& sampleInside_;
  const LargeVector<float>& growth_;
  bool hasSolids_;
  SignedSamples result_;
  LargeVector<float> sheetDistances_;
  LargeVector<std::uint32_t> sheetTriangles_;
};

void fillIndirection(BrickLevel& level, const LevelSamples& samples, const LevelSigns& signs) {
  for (std::size_t cell = 0; cell < samples.brickOfCell.size(); ++cell) {
    const bool inside = samples.cellInSheet[cell] || (!signs.cellInside.empty() && signs.cellInside[cell]);
    level.indirection[cell] = samples.brickOfCell[cell] != kNoBrick
                                  ? IndirectionCell::brick(samples.brickOfCell[cell]).bits
                                  : IndirectionCell::empty(inside, samples.cellBounds[cell]).bits;
  }
}

BrickLevel packLevel(const LevelBakeRequest& request, const LevelSamples& samples, const LevelSigns& signs,
                     SampleUnion& united) {
  const std::size_t bricks = samples.brickCount();
  BrickLevel level = makeLevel(request.layout, request.format, kNarrowBandVoxels);
  if (!request.sampling.isComplete) {
    level.distances.resize(bricks * kSamples * bytesPerSample(level.format));
    tbb::parallel_invoke(
        [&] { fillIndirection(level, samples, signs); },
        [&] { forEachUneven(bricks, 8, [&](std::size_t b) { writeBrickVoxels(level, b, united.unite(b)); }); });
    return level;
  }
  // The range is that of the farthest sample.
  level.format = DistanceFormat::R16Snorm;
  level.distances.resize(bricks * kSamples * bytesPerSample(level.format));
  std::vector<const float*> voxels(bricks);
  forEachUneven(bricks, 8, [&](std::size_t b) { voxels[b] = united.unite(b).data(); });
  for (const float* ofBrick : voxels)
    for (std::size_t i = 0; i < kSamples; ++i)
      level.rangeVoxels = std::max(level.rangeVoxels, rangeVoxelsWithoutClamp(std::abs(ofBrick[i])));
  fillIndirection(level, samples, signs);
  forEachUneven(bricks, 8, [&](std::size_t b) { writeBrickVoxels(level, b, BrickVoxels(voxels[b], kSamples)); });
  return level;
}

/// Attributes of one brick.
class BrickAttributes {
public:
  BrickAttributes(const LevelBakeRequest& request, const SignedSamples& samples, glm::ivec3 brick, std::size_t begin)
      : request_(request), samples_(samples), brick_(brick), begin_(begin) {}

  void fill(BrickLevel& level) const {
    PackedAttributes last = at(leastDistant());
    const bool isSame = request_.attributes->isUniform() && !request_.sampling.surfaces->sheets; // slabs have coverage
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (!isSame && std::abs(samples_.distances[begin_ + i]) <= kAttributeVoxels) last = at(i);
      level.baseColor[begin_ + i] = last.baseColor;
      level.material[begin_ + i] = last.material;
      if (!level.emission.empty()) level.emission[begin_ + i] = last.emission;
    }
  }

private:
  std::size_t leastDistant() const {
    const auto begin = samples_.distances.begin() + static_cast<std::ptrdiff_t>(begin_);
    const auto isNearer = [](float a, float b) { return std::abs(a) < std::abs(b); };
    return static_cast<std::size_t>(std::min_element(begin, begin + kSamples, isNearer) - begin);
  }
  PackedAttributes at(std::size_t i) const {
    std::uint32_t triangle = samples_.triangles[begin_ + i];
    const glm::dvec3 sample = request_.sampling.grid.sample(brick_, sampleOfIndex(i));
    if (samples_.distances[begin_ + i] < 0 && !samples_.isSheet[begin_ + i] && !request_.attributes->isUniform())
      triangle = coatOf(triangle, sample);
    const auto corners = request_.sampling.soup->corners(triangle);
    const PointOnTriangle on = closestPointOnTriangle(sample, corners);
    PackedAttributes packed = request_.attributes->at(triangle, on, sample, request_.layout.voxelSizeObject);
    if (samples_.isSheet[begin_ + i] && request_.attributes->isSingleSided(triangle))
      coverFrontOnly(packed, glm::dot(sample - on.point, frontOf(corners)) + behindMiddle(triangle));
    return packed;
  }
  /// The triangle that is seen before the one closest to a sample inside: where a coat thinner than a voxel lies on
  /// another solid (iron bands on a beam, a name plate), samples below both are closest to what the coat hides.
  ///
  ///   outside         probe: one voxel before the hidden triangle
  ///   ==============  coat: closest to the probe, and the hidden triangle lies behind it
  ///   --------------  closest to the sample
  ///   inside          sample
  std::uint32_t coatOf(std::uint32_t triangle, glm::dvec3 sample) const {
    const TriangleSoup& soup = *request_.sampling.soup;
    const double voxel = request_.sampling.grid.voxelSize, slack = kCoatSlackVoxels * voxel;
    const auto corners = soup.corners(triangle);
    const glm::dvec3 on = closestPointOnTriangle(sample, corners).point, front = frontOf(corners);
    const double away = glm::length(on - sample);
    glm::dvec3 outwards = away > slack ? (on - sample) / away : front;
    if (glm::dot(outwards, front) < 0) outwards = -outwards; // the sample lies in the coat
    const glm::dvec3 probe = on + kCoatVoxels * voxel * outwards;
    const ClosestTriangle coat = request_.sampling.surfaces->solid->closest(probe, kCoatVoxels * voxel, triangle);
    if (coat.triangle == kNoTriangle || coat.triangle == triangle) return triangle;
    const glm::dvec3 coatFront = frontOf(soup.corners(coat.triangle));
    const bool isHidden = glm::dot(on - coat.on.point, coatFront) < -slack;
    return isHidden && glm::dot(probe - coat.on.point, coatFront) > 0 ? coat.triangle : triangle;
  }
  static glm::dvec3 frontOf(const std::array<glm::dvec3, 3>& corners) {
    return glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  }
  /// How far the middle of a triangle's slab lies behind it.
  double behindMiddle(std::uint32_t triangle) const {
    const double half = request_.sampling.halfThickness;
    return request_.sampling.surfaces->slabs->isBehind(triangle) ? 0.5 * SheetSlabs::depthOf(half) : 0.0;
  }
  /// A slab of a single-sided material is seen from its front alone: coverage runs from 0 to 1 over the voxel around
  /// the slab's middle, so that read at the slab's faces, half a voxel away or more, it is under 1/4 behind and over
  /// 3/4 in front.
  void coverFrontOnly(PackedAttributes& packed, double beforeMiddle) const {
    glm::vec4 color = unpackRgba8(packed.baseColor);
    color.w *= static_cast<float>(std::clamp(0.5 + beforeMiddle / request_.sampling.grid.voxelSize, 0.0, 1.0));
    packed.baseColor = packRgba8(color);
  }

  const LevelBakeRequest& request_;
  const SignedSamples& samples_;
  glm::ivec3 brick_;
  std::size_t begin_;
};

void fillAttributes(BrickLevel& level, const LevelBakeRequest& request, const LevelSamples& samples,
                    const SignedSamples& signedSamples) {
  level.baseColor.resize(samples.brickCount() * kSamples);
  level.material.resize(samples.brickCount() * kSamples);
  if (request.attributes->hasEmission()) level.emission.resize(samples.brickCount() * kSamples);
  tbb::parallel_for(std::size_t{0}, samples.brickCount(), [&](std::size_t b) {
    request.sampling.done(0);
    const glm::ivec3 brick = samples.grid.brickOfCell(samples.cellOfBrick[b]);
    BrickAttributes(request, signedSamples, brick, b * kSamples).fill(level);
  });
}

} // namespace

BrickLevel bakeLevel(const LevelBakeRequest& request) {
  BakeSeconds& seconds = request.stats->stages;
  LevelSamples samples = timed(seconds.distance, [&] { return sampleLevel(request.sampling); });
  request.stats->queries += samples.queries;
  LevelSigns signs;
  LargeVector<float> growth;
  if (request.inside) {
    const StageClock clock(seconds.sign);
    signs = floodSigns(samples, *request.inside);
    insertMembranes(request.sampling, *request.inside, samples, signs);
    if (request.thickness) growth = growThinSolids(*request.thickness, request.sampling, samples, signs.sampleInside);
  }
  SignedSamples signedSamples;
  BrickLevel level;
  {
    const StageClock clock(seconds.packing);
    SampleUnion united(samples, signs.sampleInside, growth);
    level = packLevel(request, samples, signs, united);
    signedSamples = united.take();
  }
  if (request.attributes) {
    const StageClock clock(seconds.attributes);
    fillAttributes(level, request, samples, signedSamples);
  }
  if (request.signedVoxels) *request.signedVoxels = std::move(signedSamples.distances);
  return level;
}

} // namespace brickfield
