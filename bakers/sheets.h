// Which triangles are sheets: with open space on both sides, as leaves, planes, walls and cloth have. A field of solids
// would lose them, or fill the room that they stand around, so they are given a thickness instead.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bakers/inside_test.h"
#include "bakers/mesh_hierarchy.h"
#include "bakers/mesh_topology.h"

namespace brickfield {

/// What each triangle of a soup counts as.
struct SolidsAndSheets {
  std::vector<std::uint32_t> solid;
  std::vector<std::uint32_t> sheets;
  /// Of the solid ones, where the look at the others took them.
  std::unique_ptr<MeshHierarchy> solidHierarchy;
  std::optional<SolidWinding> solidWinding; ///< by solidHierarchy
};

struct SheetRequest {
  double halfThickness = 0;        ///< soup space: how far from the triangle its two sides are looked at
  double voxelSize = 0;            ///< soup space: triangles of more than eight voxels are looked at in several places
  std::vector<bool> isCutOut;      ///< a triangle: its material has holes (alpha mask or blend)
  std::vector<bool> isDoubleSided; ///< a triangle: its material shows both sides
};

/// Splits the triangles of a soup.
///
/// Closed components are solid without a look, except for flat pairs: coincident triangles that face each other's way
/// and so enclose nothing. Those are one sheet unless a solid holds them. Open components are judged as a whole, so
/// that no seam runs through a shell: by how far they come from closing, the mean winding number close to their
/// triangles. One that falls short is all sheets: a room of two walls is no solid that fills half of the room. Where
/// both sides show, the inside was made to be seen, and almost a whole turn is asked for (kClosedTwoSided,
/// kClosedOneSided). Sheets are taken away and the rest is looked at again, until none is left to find: the half turn
/// that a plane makes close to itself would else drown the sign of its surroundings. A component that is left as solid
/// loses its flaps, triangles with open space on both sides, to the sheets if they are more than a fiftieth of its
/// area. Open triangles with holes in their material (leaf cards) are sheets without a look.
///
/// cost      about one winding number a triangle and one of the found sheets a triangle and round, all threads
/// proved by tests/bake/bakers/sheets_test.cpp
SolidsAndSheets findSheets(const TriangleSoup& soup, const MeshTopology& topology, const SheetRequest& request);

} // namespace brickfield
