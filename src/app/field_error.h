// How far a field's stored distances are from the exact ones of the mesh it came from.
#pragma once

#include <cstdint>

#include "bakers/bake.h"

namespace brickfield {

struct FieldError {
  std::uint64_t samples = 0;
  double meanVoxels = 0; ///< absolute, in voxels of the finest level
  double rmsVoxels = 0;
  double maxVoxels = 0;
};

/// Compares the distances stored in the bricks of the finest level, evenly thinned out, with exact ones. Magnitudes
/// only: the side is not judged. Clamped samples are left out; sheets differ by half their thickness.
///
/// mostSamples at least 1
/// error  BadInput: the mesh has no triangle; Failure: the field has no unclamped sample
FieldError compareWithMesh(const BrickField& field, const BakeInput& mesh, std::uint64_t mostSamples);

} // namespace brickfield
