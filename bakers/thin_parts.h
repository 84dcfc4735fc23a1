// Parts of closed solids that are thinner than a voxel and would fall between the samples: how much there is of them,
// and how far each sample's surface is moved out so that nothing is lost.
//
//   solid         ------------   thickness T       grown    ------------  (1.755 voxels - T) / 2 farther out,
//                 ------------                              ============  but by 0.5625 voxel at most
//                                                           ------------
#pragma once

#include "bakers/level_sampler.h"
#include "bakers/solid_thickness.h"
#include "field/brick_field.h"

namespace brickfield {

/// Less is the rims of sharp edges and tips.
inline constexpr double kThinShareAllowed = 0.01;
/// Solids this thick keep smooth sides, as slabs do that lie behind their fronts: no corner of a cell that one side
/// crosses is deeper than the cell's diagonal, and nearer to the other side. Thinner ones ripple.
inline constexpr double kSmoothSolidVoxels = 1.755;
/// By so much a solid without any thickness is as thick as a slab of sheets, and cannot fall between two samples.
inline constexpr double kMostGrowthVoxels = 0.5625;

/// Share of the closed solid surface behind which the solid ends within a voxel, and the resolution at which no more
/// than kThinShareAllowed of it would. Sheets do not count: their slabs are never lost.
///
/// voxelSize  soup space
/// resolution that gives such voxels
/// returns    to the accuracy of 4096 places, 0.5 % at most; nothing where none of the first 1024 is thin
/// cost       1024 or 4096 thicknesses; all threads, the same result on any number
/// proved by  tests/bake/bakers/thin_parts_test.cpp
ThinParts findThinParts(const SolidThickness& thickness, double voxelSize, int resolution);

/// How far, in voxels, the surface that is closest to each sample of a level is moved outwards: continuous in the
/// thickness, nothing from kSmoothSolidVoxels on, for open solids and far from the surface.
///
/// cost      a thickness for each sample within three voxels of closed solids; all threads
/// proved by tests/bake/bakers/thin_parts_test.cpp
LargeVector<float> growThinSolids(const SolidThickness& thickness, const SamplingRequest& request,
                                  const LevelSamples& level, const LargeVector<std::uint8_t>& sampleInside);

} // namespace brickfield
