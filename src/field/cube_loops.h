// Where the surface leaves a cell: closed loops over the cell's edges, each of which becomes a piece of the surface.
// Marching cubes (Lorensen and Cline 1987) without a table: the loops are walked face by face. Faces whose signs allow
// two readings are decided by the saddle of their bilinear patch (Nielson and Hamann 1991), which two cells that share
// a face see alike; so pieces of neighbouring cells always fit.
//
//   corner i at (i & 1, i >> 1 & 1, i >> 2)        edge 4 a + u + 2 v runs along axis a, u and v are its places on
//                                                  the next two axes in x y z x
#pragma once

#include <array>
#include <cstdint>

#include "field/brick_lookup.h"

namespace brickfield {

inline constexpr int kCubeEdges = 12;

struct CubeLoops {
  std::array<std::uint8_t, kCubeEdges> edges{}; ///< of all loops, one after another
  std::array<std::uint8_t, 4> lengths{};        ///< 3 to 12 edges a loop
  std::size_t count = 0;
};

/// The lower and the upper corner of an edge.
struct EdgeCorners {
  std::size_t low = 0, high = 0;
};
EdgeCorners cornersOfEdge(int edge);

/// Zero counts as inside: where surfaces are hidden in a solid, distances go up to zero and no farther.
inline bool isInsideValue(double value) { return value <= 0; }

/// The loops between corners inside and all others. Each edge that leads from one side to the other is in exactly one
/// loop, which turns counter-clockwise as seen from outside. Edges of a loop of three or four never lie in
/// one face unless they follow each other, so its triangles meet those of the next cell nowhere but at the loop.
///
/// values     finite; only signs count, but for the faces with two readings
/// proved by  tests/unit/field/cube_loops_test.cpp, all 256 signs
CubeLoops findCubeLoops(const VoxelCorners& values);

} // namespace brickfield
