// How far the samples that a field stores are from the mesh it is said to come from: a check that shares no more with
// the bake than its triangles and its distance query.
#pragma once

#include <cstdint>
#include <vector>

#include "bakers/bake.h"

namespace brickfield {

/// Lengths in voxels of the level.
struct LevelError {
  std::uint64_t samples = 0;                   ///< not clamped, and nearest to a closed component
  double mean = 0, rms = 0, p999 = 0, max = 0; ///< of the magnitudes of their errors, and the 99.9th percentile
  std::uint64_t signedSamples = 0;             ///< nearest to a closed component, clamped ones too
  std::uint64_t wrongSigns = 0;
  double farthestWrongSign = 0; ///< from the surface
  /// Nearest to an open part: solid behind it or a slab around it, by the bake's choice. Unsigned distances.
  std::uint64_t openSamples = 0;
  double openRms = 0, openMax = 0;
};

struct BakeError {
  std::uint64_t triangles = 0;       ///< of positive area
  std::uint64_t closedTriangles = 0; ///< of closed components
  std::uint64_t openEdges = 0, nonManifoldEdges = 0;
  std::vector<LevelError> levels; ///< finest first
};

/// Compares stored samples, evenly thinned out, with exact distances. Inside is what closed components wrap at all
/// (winding numbers, asked for at each sample); coinciding pairs of triangles count as open. Signs nearer than 1/1000
/// voxel to the surface are not judged.
///
/// mostSamples  a level, at least 1
/// error        BadInput: the mesh has no triangle of positive area
/// cost         one thread's 2 us a sample, on all threads
/// proved by    tests/bake/bakers/bake_error_test.cpp
BakeError measureBakeError(const BrickField& field, const BakeInput& mesh, std::uint64_t mostSamples);

} // namespace brickfield
