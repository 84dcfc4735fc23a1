// SDF objects on the GPU. Grid space of an object: origin at sample 0, unit = one voxel of the finest level.
#ifndef BRICKFIELD_SDF_PARAMS_H
#define BRICKFIELD_SDF_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

struct SdfInstance {
  vec4 gridFromWorld[3]; // rows of the affine transform
  vec4 worldFromGrid[3];
  vec4 boxMin; // grid space; w: largest metres of world that one voxel spans
  vec4 boxMax; // grid space; w: smallest metres of world that one voxel spans
  ivec4
      ids; // x: node; y: first row in the level table; z: levels; w: SDF_* flags, the field's number << SDF_FIELD_SHIFT
};
SHARED_ASSERT_SIZE(SdfInstance, 144)

// Where an instance was in the frame before.
struct SdfMotion {
  vec4 previousWorldFromGrid[3];
};
SHARED_ASSERT_SIZE(SdfMotion, 48)

// What an SDF object looks like beside its own attributes; a row for each that is drawn.
struct SdfLook {
  vec4 objectFromGrid; // xyz: where sample 0 lies in object space; w: metres of object space a voxel
  vec4 texturing;      // x: metres of object space that triplanar textures span, 0: none; y: row of their material
  vec4 transmission;   // rgb: colour of the diffuse light that passes; w: its share
  vec4 absorption;     // rgb: per metre of world
};
SHARED_ASSERT_SIZE(SdfLook, 64)

SHARED_CONST uint SDF_DOUBLE_SIDED = 1;
SHARED_CONST uint SDF_FIELD_SHIFT = 8;

struct SdfLevel {
  uvec4 cells; // x: first indirection cell; y, z, w: bricks along each axis
  vec4 scale;  // x: level voxels a grid voxel (1, 1/2, 1/4); y: voxels of the stored value 1; z: 1 in the R16 pool;
               // w: a texel's part of that pool's depth (to ask a texture for its size costs as much as a read)
  uvec4 attributes; // x: first cell of the attribute indirection, or SDF_NO_ATTRIBUTES
};
SHARED_ASSERT_SIZE(SdfLevel, 48)

SHARED_CONST uint SDF_NO_ATTRIBUTES = 0xffffffffu;

// In the table of nodes: no instance of it has bricks.
SHARED_CONST uint NO_BRICKS = 0xffffffffu;

// Indirection cell, as in field/brick_field.h, with the slot of the pool for the index.
SHARED_CONST uint CELL_EMPTY = 0x80000000u;
SHARED_CONST uint CELL_INSIDE = 0x40000000u;
SHARED_CONST uint CELL_BOUND_MASK = 0xffffu;

SHARED_CONST uint BRICK_SAMPLES = 8u;
SHARED_CONST uint BRICK_CELLS = 7u;
SHARED_CONST uint BRICK_POOL_SIDE = 64u;           // slots along x and y of a pool's textures; a power of two
SHARED_CONST float BRICK_POOL_TEXEL = 1.0 / 512.0; // a texel's part of a pool's width

// A visible object, as the box pass takes it from its instance attribute: index and flags.
SHARED_CONST uint VISIBLE_INDEX_MASK = 0x00ffffffu;
SHARED_CONST uint VISIBLE_LEVEL_SHIFT = 24u;
SHARED_CONST uint VISIBLE_LEVEL_MASK = 0x7u;
SHARED_CONST uint VISIBLE_INSIDE = 0x80000000u;

// DrawArraysIndirectCommand of the visible boxes: one for the faces that look at the eye, one for the far faces of
// boxes that the near plane or the eye may cut.
struct BoxCommand {
  uint vertices;
  uint instances;
  uint firstVertex;
  uint baseInstance;
};
SHARED_ASSERT_SIZE(BoxCommand, 16)

SHARED_CONST uint BOX_COMMAND_FACING = 0;
SHARED_CONST uint BOX_COMMAND_NEAR_PLANE = 1;
SHARED_CONST uint BOX_COMMANDS = 2;

// The pixels that a visible object's box may touch, first and last x | y << 16, and a distance from the eye before
// which none of it lies.
struct ScreenBox {
  uint first;
  uint last;
  uint entry;    // of the list of visible objects
  float nearest; // metres
};
SHARED_ASSERT_SIZE(ScreenBox, 16)

SHARED_CONST uint SDF_TILE_WIDTH = 16u, SDF_TILE_HEIGHT = 16u;

// Counters of a frame (storage buffer, one uint each).
SHARED_CONST uint COUNTER_FRAGMENTS = 0;
SHARED_CONST uint COUNTER_HITS = 1;
SHARED_CONST uint COUNTER_STEPS = 2;
SHARED_CONST uint COUNTER_BRICK_READS = 3;
SHARED_CONST uint COUNTER_PROMISE_BROKEN = 4;
SHARED_CONST uint COUNTER_OUT_OF_STEPS = 5;
SHARED_CONST uint COUNTER_SHADOW_READS = 6;
SHARED_CONST uint COUNTER_OCCLUSION_READS = 7;
SHARED_CONST uint COUNTER_INSIDE_STEPS = 8; // of rays within objects
SHARED_CONST uint COUNTER_REFLECTION_READS = 9;
SHARED_CONST uint COUNTER_MAP_FRAGMENTS = 12; // boxes in shadow maps
SHARED_CONST uint COUNTER_MAP_STEPS = 13;
SHARED_CONST uint COUNTERS = 16;

SHARED_END

#endif
