// How far a baked band is from brute force over all triangles in double.
#pragma once

#include "bakers/band_bake.h"

namespace brickfield {

struct BandAccuracy {
  std::size_t samples = 0;
  double largestError = 0;      ///< voxels, of the distances before they are coded; within the range
  double largestCodedError = 0; ///< voxels, of what is stored
  double quantum = 0;           ///< voxels, the step of the code: no coded distance should be farther off
  std::size_t wrongSigns = 0;   ///< against the exact winding number at one half, of either sign
  double farthestTurns = 0;     ///< of those with wrong signs: how far their winding number is from one half
};

/// Samples spread evenly over the bricks. Distances are compared with those to triangles: a band with sheets, with thin
/// solids drawn thicker or with membranes (open meshes) has others by intent.
///
/// band     baked with SignMethod::Winding
/// cost     samples times triangles, about 60 ns each, all threads
/// proved by tests/bake/bakers/band_bake_test.cpp
BandAccuracy measureBand(const BandBake& band, std::size_t samples);

} // namespace brickfield
