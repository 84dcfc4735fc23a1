// Parts of closed solids that are thinner than a voxel and would fall between the samples: how much there is of them,
// and how far each sample's surface is moved out so that nothing is lost.
//
//   solid         ------------   thickness T       grown    ------------  (1.125 voxels - T) / 2 farther out
//                 ------------                              ============  the solid
//                                                           ------------
#pragma once

#include "bakers/level_sampler.h"
#include "bakers/solid_thickness.h"
#include "field/brick_field.h"

namespace brickfield {

/// Less is the rims of sharp edges and tips.
inline constexpr double kThinShareAllowed = 0.01;
/// What every solid is drawn as at least, as thin as a slab of sheets: less could fall between two samples.
inline constexpr double kLeastSolidVoxels = 1.125;
inline constexpr double kMostGrowthVoxels = 0.5 * kLeastSolidVoxels;

/// Share of the closed solid surface behind which the solid ends within a voxel, and the resolution at which no more
/// than kThinShareAllowed of it would. Sheets do not count: their slabs are never lost.
///
/// voxelSize  soup space
/// resolution that gives such voxels
/// returns    to the accuracy of 4096 places, 0.5 % at most
/// cost       4096 thicknesses; all threads, the same result on any number
/// proved by  tests/bake/bakers/thin_parts_test.cpp
ThinParts findThinParts(const SolidThickness& thickness, double voxelSize, int resolution);

/// How far, in voxels, the surface that is closest to each sample of a level is moved outwards: continuous in the
/// thickness, nothing from kLeastSolidVoxels on, for open solids and far from the surface.
///
/// cost      a thickness for each sample within three voxels of closed solids; all threads
/// proved by tests/bake/bakers/thin_parts_test.cpp
std::vector<float> growThinSolids(const SolidThickness& thickness, const SamplingRequest& request,
                                  const LevelSamples& level);

} // namespace brickfield
