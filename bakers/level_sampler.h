// Distances of one level: which bricks the surface touches, and the unsigned distances at their samples. It knows no
// signs; sign_flood.h adds them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bakers/mesh_distance.h"
#include "bakers/sheet_slabs.h"
#include "field/brick_layout.h"

namespace brickfield {

inline constexpr std::uint32_t kNoBrick = ~0u;

/// The surfaces that a bake measures.
struct BakeSurfaces {
  std::optional<MeshDistance> solid;
  std::optional<MeshDistance> sheets;
  std::optional<SheetSlabs> slabs; ///< of the sheets, wherever there are some
};

/// Samples of a level in soup space.
struct SampleGrid {
  glm::dvec3 origin{0.0};
  double voxelSize = 0;
  glm::ivec3 brickCounts{0};

  glm::dvec3 sample(glm::ivec3 brick, glm::ivec3 index) const {
    return origin + voxelSize * glm::dvec3(kBrickCells * brick + index);
  }
  glm::dvec3 brickCenter(glm::ivec3 brick) const {
    return origin + voxelSize * static_cast<double>(kBrickCells) * (glm::dvec3(brick) + 0.5);
  }
  glm::ivec3 brickOfCell(std::size_t cell) const {
    const auto x = static_cast<std::size_t>(brickCounts.x), y = static_cast<std::size_t>(brickCounts.y);
    return {cell % x, cell / x % y, cell / (x * y)};
  }
  std::size_t cellOfBrick(glm::ivec3 brick) const {
    return static_cast<std::size_t>((brick.z * brickCounts.y + brick.y)) * static_cast<std::size_t>(brickCounts.x) +
           static_cast<std::size_t>(brick.x);
  }
  /// Calls visit(brick) in the order of cells.
  template <typename Visit>
  void forEachCell(const Visit& visit) const {
    glm::ivec3 brick;
    for (brick.z = 0; brick.z < brickCounts.z; ++brick.z)
      for (brick.y = 0; brick.y < brickCounts.y; ++brick.y)
        for (brick.x = 0; brick.x < brickCounts.x; ++brick.x) visit(brick);
  }
  std::size_t cellCount() const {
    return static_cast<std::size_t>(brickCounts.x) * static_cast<std::size_t>(brickCounts.y) *
           static_cast<std::size_t>(brickCounts.z);
  }
};

/// Distances in voxels of the level. Arrays over bricks hold 512 samples a brick; those of sheets are empty without
/// any.
struct LevelSamples {
  SampleGrid grid;
  double halfThickness = 0;               ///< soup space
  std::vector<float> cellBounds;          ///< a cell: at most the distance of any of its points to the surface
  std::vector<std::uint8_t> cellInSheet;  ///< a cell: its centre lies in a sheet's slab
  std::vector<std::uint32_t> brickOfCell; ///< kNoBrick where the surface stays away
  std::vector<std::uint32_t> cellOfBrick;
  LargeVector<float> solidDistances;         ///< unsigned; where beyond the range, some lower bound beyond it
  LargeVector<std::uint32_t> solidTriangles; ///< closest, or one not far from that where beyond the range; if kept
  LargeVector<float> sheetDistances;         ///< negative inside the slab
  LargeVector<std::uint32_t> sheetTriangles; ///< if kept

  std::uint64_t queries = 0; ///< points whose distance was asked for

  std::size_t brickCount() const { return cellOfBrick.size(); }
};

struct SamplingRequest {
  const TriangleSoup* soup = nullptr;
  const BakeSurfaces* surfaces = nullptr;
  SampleGrid grid;
  double halfThickness = 0;     ///< soup space
  double solidGrowthVoxels = 0; ///< at most so far will solids be moved outwards (thin_parts.h)
  bool keepsTriangles = true;   ///< the closest ones, which only colors and thicknesses ask for
  bool isComplete = false;      ///< every cell becomes a brick, no distance is capped: the coarsest level
  std::function<void(std::size_t bricks)> admit; ///< asked before memory for so many bricks is taken; may throw
  std::function<void(std::size_t bricks)> done;  ///< called from any thread as bricks are finished; may throw
};

/// Position in the brick of sample number `index`.
inline glm::ivec3 sampleOfIndex(std::size_t index) {
  const auto i = static_cast<int>(index);
  return {i % kBrickSamples, i / kBrickSamples % kBrickSamples, i / (kBrickSamples * kBrickSamples)};
}

/// Distances of one brick, as LevelSamples has them.
struct BrickSamples {
  std::array<float, kBrickSampleCount> solidDistances, sheetDistances;
  std::array<std::uint32_t, kBrickSampleCount> solidTriangles, sheetTriangles;
};

/// isCapped  distances beyond the range need not be exact
void sampleBrick(const SamplingRequest& request, glm::ivec3 brick, bool isCapped, BrickSamples& samples);

/// Puts a brick's samples in the place of the cell's brick, or at the end as a new one.
void storeBrick(const SamplingRequest& request, std::size_t cell, const BrickSamples& samples, LevelSamples& level);

/// Lower bound in voxels over a closed brick, from the least unsigned distance of its samples.
float boundBySamples(float leastVoxels);

/// A brick is stored if the surface may come within kTouchVoxels of its closed box: by the distance at its centre, then
/// at those of its eighths (unless what is closest to its centre comes into one), at last by its samples.
///
/// Samples that bricks share are measured once.
///
/// cost  on one core 0.02 to 0.4 us a sample; all threads of the arena, the same result on any number
LevelSamples sampleLevel(const SamplingRequest& request);

} // namespace brickfield
