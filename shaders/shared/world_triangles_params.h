// Tables of the passes that gather the world's triangles; what they make is in world_field_params.h.
#ifndef BRICKFIELD_WORLD_TRIANGLES_PARAMS_H
#define BRICKFIELD_WORLD_TRIANGLES_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

SHARED_CONST uint kGatherTriangleBinding = 0;
SHARED_CONST uint kGatherInstanceBinding = 1;
SHARED_CONST uint kGatherTopologyBinding = 2;
SHARED_CONST uint kGatherChunkBinding = 3;
SHARED_CONST uint kGatherVertexBinding = 4;   // of the positions
SHARED_CONST uint kGatherFanStartBinding = 4; // of the pseudonormals
SHARED_CONST uint kGatherFanCornerBinding = 5;
SHARED_CONST uint kGatherFaceBinding = 6;

// A triangle of a mesh, the same for all its instances.
struct TopologyRow {
  uvec4 corners;    // xyz: vertices of the mesh pool, undeformed; w: WORLD_TRIANGLE_*
  uvec4 neighbours; // xyz: triangles of the mesh beyond the edges ab, bc, ca, or NO_NEIGHBOUR
};
SHARED_ASSERT_SIZE(TopologyRow, 32)

// What a world triangle gives to the pseudonormals around it; rows as those of the world triangles.
struct WorldFace {
  vec4 normal; // unit; zero where the triangle has none to speak of
  vec4 angles; // at the corners a, b and c
};
SHARED_ASSERT_SIZE(WorldFace, 32)

SHARED_CONST uint NO_NEIGHBOUR = 0xffffffffu;

// Work of one group: up to GATHER_TRIANGLES triangles, or welded vertices, of one instance.
struct GatherChunk {
  uint instance;
  uint first; // of the mesh's triangles or welded vertices
  uint count;
  uint vertexOffset; // from the pool's undeformed vertices to those to take, modulo 2^32; of triangles only
};
SHARED_ASSERT_SIZE(GatherChunk, 16)

// In WorldInstance::vertices.w
SHARED_CONST uint WORLD_INSTANCE_MIRRORED = 1; // the winding turns: b and c, and with them ab and ca, change places
SHARED_CONST uint WORLD_INSTANCE_FLAT = 2;     // its transform leaves no inside: all sheets

SHARED_END

#endif
