// The passes of the method of the RTSDF paper. They have a volume of their own; it covers the scene.
#ifndef BRICKFIELD_RTSDF_PARAMS_H
#define BRICKFIELD_RTSDF_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

// A seed is the place of a coarse texel, ten bits an axis.
SHARED_CONST uint RTSDF_NO_SEED = 0xffffffffu;
SHARED_CONST uint RTSDF_SEED_BITS = 10;
SHARED_CONST uint RTSDF_SEED_MASK = 1023;

// Triangles that may touch more voxels than this are left to a work group each.
SHARED_CONST uint RTSDF_SMALL_VOXELS = 64;
SHARED_CONST uint RTSDF_LARGE_GROUPS = 2048; // which take the large ones in turn

SHARED_CONST uint RTSDF_ROW_THREADS = 262144;

// What the one shader of the voxelization does.
SHARED_CONST uint RTSDF_CLEAR = 0;
SHARED_CONST uint RTSDF_VOXELIZE_SMALL = 1;
SHARED_CONST uint RTSDF_VOXELIZE_LARGE = 2;

// Words of the counters: pairs of low and high halves.
SHARED_CONST uint RTSDF_COUNT_TEXELS = 0; // that rays were sent from
SHARED_CONST uint RTSDF_COUNT_RAYS = 2;
SHARED_CONST uint RTSDF_COUNT_HITS = 4;
SHARED_CONST uint RTSDF_COUNT_NODES = 6;
SHARED_CONST uint RTSDF_COUNT_TRIANGLES = 8;
SHARED_CONST uint RTSDF_COUNTERS = 10;

// Storage buffers. Those of the rays stand behind the hierarchy's three.
SHARED_CONST uint kRtsdfTriangleBinding = 0;
SHARED_CONST uint kRtsdfSeedBinding = 1;
SHARED_CONST uint kRtsdfSeedResultBinding = 2;
SHARED_CONST uint kRtsdfLargeBinding = 3;
SHARED_CONST uint kRtsdfDistanceBinding = 4;
SHARED_CONST uint kRtsdfVoteBinding = 5;
SHARED_CONST uint kRtsdfCounterBinding = 6;

SHARED_CONST uint kRtsdfCoarseUnit = 0; // texture and image unit
SHARED_CONST uint kRtsdfFieldUnit = 1;

SHARED_END

#endif
