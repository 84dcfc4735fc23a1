// Sums of what the arrays of a bake hold. Proved by tests/bake/bakers/bake_memory_test.cpp, against the process' peak.
#include "bakers/bake_memory.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bakers/large_vector.h"
#include "core/error.h"
#include "field/brick_layout.h"

namespace brickfield {

namespace {

// Measured: welded vertices, edges of the topology, hierarchies, moments for winding numbers; with a quarter to spare.
constexpr std::uint64_t kBytesPerTriangle = 350;
// Bounds, bricks, signs, patches and their regions of a cell, steps to membranes.
constexpr std::uint64_t kBytesPerCell = 40;

std::uint64_t samplesOf(std::size_t bricks) { return std::uint64_t{bricks} * kBrickSampleCount; }

/// Arrays with a value a sample: distances by surface and triangles where they are kept; signs, what is a sheet's,
/// growth of thin parts; patches.
std::uint64_t workBytes(const BakeMemory::Level& level) {
  const std::uint64_t samples = samplesOf(level.bricks);
  const auto surfaces = static_cast<std::uint64_t>(level.surfaces);
  std::uint64_t bytes = surfaces * largeVectorBytes(4 * samples) + largeVectorBytes(samples) + samples;
  if (level.keepsTriangles) bytes += surfaces * largeVectorBytes(4 * samples) + largeVectorBytes(samples);
  if (level.growsSolids) bytes += largeVectorBytes(4 * samples);
  return bytes + level.cells * kBytesPerCell;
}

/// Code and attributes a sample, a word a cell.
std::uint64_t resultBytes(const BakeMemory::Level& level) {
  return samplesOf(level.bricks) * (level.hasAttributes ? 14u : 2u) + level.cells * sizeof(std::uint32_t);
}

std::string gibibytes(std::uint64_t bytes) {
  const double mebibytes = std::ldexp(static_cast<double>(bytes), -20);
  return mebibytes < 1024 ? fmt::format("{:.0f} MiB", std::ceil(mebibytes))
                          : fmt::format("{:.1f} GiB", mebibytes / 1024);
}

} // namespace

void BakeMemory::holdTriangles(std::size_t count) { triangleBytes_ = count * kBytesPerTriangle; }

void BakeMemory::admit(const Level& level) {
  const auto refuseAbove = [&](std::uint64_t needed, std::uint64_t most, const char* what) {
    if (needed > most)
      throw BadInput(label_, fmt::format("level {}", level.index),
                     fmt::format("needs {} {} for {} bricks, more than {}; lower the resolution", gibibytes(needed),
                                 what, level.bricks, gibibytes(most)));
  };
  const std::uint64_t needed = triangleBytes_ + fieldBytes_ + workBytes(level) + resultBytes(level);
  refuseAbove(needed, limitBytes_ == 0 ? kMaxFieldBytes : limitBytes_, "of memory");
  fieldBytes_ += resultBytes(level);
  refuseAbove(fieldBytes_, kMaxFieldBytes, "of a file's bricks");
  peakBytes_ = std::max(peakBytes_, needed);
}

std::uint64_t mostBakeBytes(int resolution, std::size_t triangles) {
  // The surface's box and a voxel around it, in bricks of seven voxels; the next levels are an eighth of it each.
  const auto bricks = static_cast<std::size_t>(std::pow((resolution + 2) / kBrickCells + 1, 3));
  const BakeMemory::Level level{0, bricks, bricks, 2, true, true, true};
  return triangles * kBytesPerTriangle + workBytes(level) + resultBytes(level) * 8 / 7;
}

} // namespace brickfield
