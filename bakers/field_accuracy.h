// How far a world field that was read back is from the exact distances of the meshes.
#pragma once

#include <cmath>
#include <cstddef>

#include "bakers/field_truth.h"
#include "field/field_volume.h"

namespace brickfield {

/// What a field's values beside open surfaces say.
enum class SheetMeaning : std::uint8_t {
  Thick,    ///< the distance less half a texel: a sheet's own inside
  Unsigned, ///< the distance; its sign says nothing
};

/// All lengths in texels.
struct FieldAccuracy {
  std::size_t texels = 0;           ///< within four texels of a surface, on the right side of it
  double rms = 0, p999 = 0;         ///< of them: of errors, and the 99.9th percentile of their magnitudes
  double worst = 0;                 ///< of the magnitudes
  double farAbove = 0;              ///< beyond and outside: largest value above the truth, which a ray would step by
  double farBelow = 0, farMean = 0; ///< beyond: largest below it, mean magnitude
  std::size_t signedTexels = 0;     ///< nearest to a closed surface
  double wrongSigns = 0;            ///< share of them
  double farthestWrongSign = 0;     ///< from the surface
  /// Left out: what is near lies within a closed surface, folds of one or sheets too, so that no nearest one tells the
  /// side.
  std::size_t overlaps = 0;
};

/// Compares the texels' centres, evenly thinned out. Values at the range stand for all that is farther.
///
/// mostTexels   at least 1
/// boundsWorld  only texels in it; absent: all
/// cost         a query of all closed parts a texel, on all threads
/// proved by    tests/oracle/world_field/field_accuracy_test.cpp
FieldAccuracy measureAccuracy(const FieldVolume& volume, glm::dvec3 anchorWorld, const FieldOracle& oracle,
                              SheetMeaning sheets, std::size_t mostTexels,
                              const Box& boundsWorld = {glm::vec3(-INFINITY), glm::vec3(INFINITY)});

} // namespace brickfield
