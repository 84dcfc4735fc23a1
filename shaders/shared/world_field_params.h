// The world field on the GPU. Spaces: anchored = metres of world from an anchor near the camera, so that 10 km from the
// origin floats still tell millimetres apart; lattice = texels of a cascade counted from the anchor, a texel's centre
// at half numbers; slot = lattice modulo the cascade's size, which is where a texel lies in memory whatever the window.
#ifndef BRICKFIELD_WORLD_FIELD_PARAMS_H
#define BRICKFIELD_WORLD_FIELD_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

// A triangle of a drawn instance where it stands this frame. Pseudonormals (Baerentzen and Aanaes 2005) are octahedral,
// SNORM 2x16: angle weighted at the corners, sums of both faces at the edges; they tell inside from outside on closed
// surfaces whatever feature is closest. Folded edges are coded in another way, see WORLD_TRIANGLE_FOLDED.
struct WorldTriangle {
  vec4 a; // anchored; w: bits of the corner's pseudonormal
  vec4 b;
  vec4 c;
  uvec4 codes; // x, y, z: pseudonormals of the edges ab, bc, ca; w: node << 2 | WORLD_TRIANGLE_*
};
SHARED_ASSERT_SIZE(WorldTriangle, 64)

SHARED_CONST uint WORLD_TRIANGLE_CLOSED = 1; // of a closed surface: its distance is signed; else it is a sheet
SHARED_CONST uint WORLD_TRIANGLE_EMPTY = 2;  // not finite, or of an instance that is not drawn: no triangle at all
SHARED_CONST uint WORLD_TRIANGLE_NODE_SHIFT = 2;
// In place of an edge's pseudonormal where both faces fold onto each other: the lower half of the word is this, which
// no packed direction has; from bit 16 on, a bit for each of as many equal parts of the edge, in its direction: 1 where
// what is nearest to it lies outside.
SHARED_CONST uint WORLD_TRIANGLE_FOLDED = 0x8000;
SHARED_CONST uint WORLD_TRIANGLE_FOLD_PARTS = 16;

// Each group of GATHER_TRIANGLES threads makes as many triangles, or pseudonormals, of one instance.
SHARED_CONST uint GATHER_TRIANGLES = 64;

// An instance of a mesh as the gathering passes see it.
struct WorldInstance {
  mat4 anchoredFromObject;
  uvec4 triangles; // x: first world triangle; y: count; z: first row of the mesh's corner table; w: node << 2 | flags
  uvec4
      vertices; // x: first welded vertex of the instance; y: count; z: first row of the fan table; w: WORLD_INSTANCE_*
};
SHARED_ASSERT_SIZE(WorldInstance, 96)

SHARED_CONST uint FIELD_TILE = 8;          // texels along a tile's side
SHARED_CONST uint FIELD_TILE_TEXELS = 512; // the smallest part that is made anew
SHARED_CONST uint MOST_CASCADES = 8;

struct FieldCascade {
  ivec4 window; // xyz: lattice of the window's first texel; w: texels along a side, a power of two
  vec4 texel; // x: metres; y: texels a metre; z: largest magnitude stored, texels; w: half a sheet's thickness, texels
  uvec4 buffers; // first x: texel, y: coarse texel, z: tile in the buffers of all cascades; w: FIELD_* flags
  vec4 extent; // xyz: texels along each axis, for readers, whom asking textures for their size costs as much as a read
};
SHARED_ASSERT_SIZE(FieldCascade, 64)

SHARED_CONST uint FIELD_WHOLE = 1; // nothing lies outside the window

struct FieldParams {
  FieldCascade cascades[MOST_CASCADES];
  ivec4 splatMin[MOST_CASCADES]; // lattice of a box, both ends included, that holds all tiles whose keys are made anew
  ivec4 splatMax[MOST_CASCADES];
  uvec4 counts; // x: cascades; y: bits of a triangle's number in a key; z: SDF instances; w: number of the update
  vec4 anchor;  // world
  uvec4 coarse; // x: coarse texels of all cascades
};
SHARED_ASSERT_SIZE(FieldParams, 96 * 8 + 48)

// What is kept of a tile.
struct FieldTile {
  uint update;       // number of the last update that made its keys anew
  uint nearest;      // triangle nearest to any of its coarse texels, or FIELD_NONE
  uint nearestBits;  // distance of the two, texels; float bits
  uint nearestTexel; // that coarse texel's number in the tile
  uvec4 found;       // x, y: a bit a coarse texel that is a seed; z: 1 where any found one in the plane across z
};
SHARED_ASSERT_SIZE(FieldTile, 32)

SHARED_CONST uint FIELD_NONE = 0xffffffffu; // no triangle; no key
// A texel's node: number + 1, 0 where nothing is in range; and whether it lies inside a closed mesh.
SHARED_CONST uint FIELD_NODE_INSIDE = 0x80000000u;
SHARED_CONST uint FIELD_NODE_MASK = 0x0fffffffu;
SHARED_CONST uint FIELD_NODE_UNCERTAIN = 0xffffffffu; // to readers: the texels around a point name different ones

// What a tile that nothing reaches holds, the same in all its texels; unknown where it is to be written anew.
SHARED_CONST uint FIELD_SIDE_UNKNOWN = 0;
SHARED_CONST uint FIELD_SIDE_OUTSIDE = 1;
SHARED_CONST uint FIELD_SIDE_INSIDE = 2;

// Up to GATHER_TRIANGLES triangles to leave their keys in one cascade.
struct FieldSplat {
  uint firstTriangle;
  uint count;
  uint cascade;
  uint unused;
};
SHARED_ASSERT_SIZE(FieldSplat, 16)

// Parts of large triangles: boxes of 16^3 texels, counted from the window's first texel, five bits an axis.
SHARED_CONST uint SPLAT_PART_TEXELS = 16;
SHARED_CONST uint SPLAT_WHOLE = 0x8000; // in place of a part: the triangle whole
SHARED_CONST uint SPLAT_CASCADE_SHIFT = 16;
SHARED_CONST uint SPLAT_PART_CAPACITY = 65536;

// What the field's passes ask first of an SDF instance; rows stand in the order of instances.
struct FieldObjectRow {
  vec4 sphere;              // around it, anchored; w: radius
  vec4 gridFromAnchored[3]; // xyz: rows of the linear part; w: a coordinate each of where the grid's origin lies,
                            // anchored
  vec4 boxMin, boxMax;      // as of SdfInstance
  vec4 points;     // xyz: first of the nearest points around its field, grid space; w: their cells' longest side
  vec4 pointCell;  // xyz: a cell, grid voxels; w: of its sides' squares the two larger, over eight
  vec4 pointBlock; // xyz: where the first lies in the texture, texels; w: the grid's diagonal, grid voxels
  ivec4 ids;
};
SHARED_ASSERT_SIZE(FieldObjectRow, 160)

// An SDF object that is to be searched for a texel; then what the texel is to hold.
struct FieldSearch {
  uint texel;   // its word in the buffers of a word a texel; FIELD_NONE: one more of another row's
  uint object;  // number of the instance
  uint more;    // row of the next one of the texel, or FIELD_NONE; then the node's word
  float metres; // distance so far; of one more of another row's the least that it may be
};
SHARED_ASSERT_SIZE(FieldSearch, 16)

// The grid of nearest surface points around an SDF object's field: points along each side, and how far it reaches
// beyond the field's box, of that box's longest side.
SHARED_CONST uint NEAREST_POINTS = 32;
SHARED_CONST float NEAREST_POINT_MARGIN = 0.75;
SHARED_CONST uint NEAREST_POINT_BLOCKS = 16; // a row of their texture, and rows of a layer

SHARED_END

#endif
