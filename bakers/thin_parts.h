// What a bake loses: parts of closed solids that are thinner than a voxel fall between the samples. Measured at places
// spread evenly over the surface, by walking from each into the solid until it ends.
//
//   surface  ----p----------------   first look half a voxel behind: a ball that
//                |                   touches nothing but p holds the whole walk
//                v  s = 1/64 .. 1 voxel, each sqrt(2) times the one before
//   opposite ---------------------   the last s that is still inside is the thickness
#pragma once

#include "bakers/inside_test.h"
#include "bakers/mesh_distance.h"
#include "field/brick_field.h"

namespace brickfield {

struct ThinPartsRequest {
  const TriangleSoup* soup = nullptr;
  const MeshTopology* topology = nullptr;
  const MeshDistance* solid = nullptr; ///< of all solid triangles, among them those of closed components
  const InsideTest* inside = nullptr;
  double voxelSize = 0; ///< soup space, of the finest level
  int resolution = 0;   ///< that gives such voxels
};

/// Share of the closed solid surface behind which the solid ends within a voxel, and the resolution at which no more
/// than kThinShareAllowed of it would. Sheets do not count: their slabs are never lost.
///
/// returns   to the accuracy of 4096 places (0.5 % at most); thickness by a factor of sqrt(2), never over
/// cost      4096 times two signs and a distance, and up to thirteen signs where something is near; all threads, the
///           same result on any number
/// proved by tests/bake/bakers/thin_parts_test.cpp
ThinParts findThinParts(const ThinPartsRequest& request);

/// Less is the rims of sharp edges and tips.
inline constexpr double kThinShareAllowed = 0.01;

} // namespace brickfield
