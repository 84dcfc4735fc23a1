// Which triangles are sheets: with open space on both sides, as leaves, planes, single-sided walls and cloth have. A
// field of solids would lose them, so they are given a thickness instead.
#pragma once

#include <vector>

#include "bakers/mesh_topology.h"

namespace brickfield {

/// What each triangle of a soup counts as; a large one that is in part a sheet stands in both lists.
struct SolidsAndSheets {
  std::vector<std::uint32_t> solid;
  std::vector<std::uint32_t> sheets;
};

struct SheetRequest {
  double halfThickness = 0;   ///< soup space: how far from the triangle its two sides are looked at
  double voxelSize = 0;       ///< soup space: triangles of more than eight voxels are looked at in several places
  std::vector<bool> isCutOut; ///< a triangle: its material has holes (alpha mask or blend)
};

/// Splits the triangles of a soup.
///
/// Closed components are solid without a look, except for flat pairs: coincident triangles that face each other's way
/// and so enclose nothing. Those are one sheet unless a solid holds them. Triangles of open components are sheets if
/// the winding number finds open space on both sides; sheets found are taken away and the rest is looked at again,
/// until none is left to find: the half turn that a plane makes close to itself would else drown the sign of its
/// surroundings. Open triangles with holes in their material (leaf cards) are sheets without a look.
///
/// cost      about one winding number a triangle and one of the found sheets a triangle and round, all threads
/// proved by tests/bake/bakers/sheets_test.cpp
SolidsAndSheets findSheets(const TriangleSoup& soup, const MeshTopology& topology, const SheetRequest& request);

} // namespace brickfield
