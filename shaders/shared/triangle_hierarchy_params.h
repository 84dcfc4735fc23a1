// The hierarchy over all world triangles: one binary tree, whose upper part is over instances and whose lower parts are
// each over the triangles of one instance. Bounds are in anchored space, as the triangles are.
#ifndef BRICKFIELD_TRIANGLE_HIERARCHY_PARAMS_H
#define BRICKFIELD_TRIANGLE_HIERARCHY_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

// A child is a word: a node's number, or HIERARCHY_LEAF with a run of the order table, which names world triangles.
SHARED_CONST uint HIERARCHY_LEAF = 0x80000000u;
SHARED_CONST uint HIERARCHY_NONE = 0xffffffffu; // nothing at all; no leaf reaches so far
SHARED_CONST uint HIERARCHY_COUNT_SHIFT = 29;   // two bits under the leaf's: triangles less one
SHARED_CONST uint HIERARCHY_FIRST_MASK = 0x1fffffffu;
SHARED_CONST uint HIERARCHY_LEAF_TRIANGLES = 4;

// Levels of nodes. The builder promises them, so a stack of one word a level never overflows. Halving reaches leaves
// of four under 26 levels from 2^28 triangles, and single instances under 20 levels from 2^20.
SHARED_CONST uint HIERARCHY_LEVELS = 26;
SHARED_CONST uint HIERARCHY_TOP_LEVELS = 20;
SHARED_CONST uint HIERARCHY_STACK = 46;

// Both children's boxes, an axis each row: left lower, left upper, right lower, right upper. A box of nothing has its
// lower side above its upper one.
struct HierarchyNode {
  vec4 x;
  vec4 y;
  vec4 z;
  uvec4 children; // x: left; y: right
};
SHARED_ASSERT_SIZE(HierarchyNode, 64)

// Nodes of one height, whose children all have their bounds already. Refitting takes those of one row at once.
struct RefitRow {
  uvec4 nodes; // x: first; y: count; or of a list of rows that one work group takes in turn: x: first row; y: count
};
SHARED_ASSERT_SIZE(RefitRow, 16)

SHARED_CONST uint REFIT_GROUP = 64;

// Storage buffers of the programs that walk or refit the hierarchy
SHARED_CONST uint kHierarchyNodeBinding = 0;
SHARED_CONST uint kHierarchyOrderBinding = 1;
SHARED_CONST uint kHierarchyTriangleBinding = 2;
SHARED_CONST uint kHierarchyRefitBinding = 3;

SHARED_END

#endif
