// Fits the bounds of nodes to their children: leaves to the triangles where they stand this frame, nodes to the boxes
// of the nodes below, which are fitted already. Minima and maxima are exact, so the result knows no order.
#include "lib/finite.glsl"
#include "shared/triangle_hierarchy_params.h"
#include "shared/world_field_params.h"

layout(local_size_x = 64) in; // REFIT_GROUP

layout(std430, binding = kHierarchyNodeBinding) coherent buffer HierarchyNodeBlock { HierarchyNode hierarchyNodes[]; };
layout(std430, binding = kHierarchyOrderBinding) readonly buffer HierarchyOrderBlock { uint hierarchyOrder[]; };
layout(std430, binding = kHierarchyTriangleBinding) readonly buffer TriangleBlock { WorldTriangle worldTriangles[]; };
layout(std430, binding = kHierarchyRefitBinding) readonly buffer RefitBlock { RefitRow refitRows[]; };

uniform uint firstRow;
uniform uint rowCount;
uniform bool takesLists; // a row stands for a list of rows

// Larger than any place of a scene (1e11 metres), small enough to be subtracted.
const float kNowhere = 1e30;

void extend(inout vec3 lower, inout vec3 upper, WorldTriangle triangle) {
  if ((triangle.codes.w & WORLD_TRIANGLE_EMPTY) != 0u) return;
  if (!isFinite(triangle.a.xyz) || !isFinite(triangle.b.xyz) || !isFinite(triangle.c.xyz)) return;
  vec3 low = min(min(triangle.a.xyz, triangle.b.xyz), triangle.c.xyz);
  vec3 high = max(max(triangle.a.xyz, triangle.b.xyz), triangle.c.xyz);
  lower = min(lower, low);
  upper = max(upper, high);
}

void boundsOfChild(uint word, out vec3 lower, out vec3 upper) {
  lower = vec3(kNowhere);
  upper = vec3(-kNowhere);
  if (word == HIERARCHY_NONE) return;
  if ((word & HIERARCHY_LEAF) != 0u) {
    uint first = word & HIERARCHY_FIRST_MASK;
    uint count = ((word & ~HIERARCHY_LEAF) >> HIERARCHY_COUNT_SHIFT) + 1u;
    for (uint i = 0u; i < count; ++i) extend(lower, upper, worldTriangles[hierarchyOrder[first + i]]);
  } else {
    vec4 x = hierarchyNodes[word].x, y = hierarchyNodes[word].y, z = hierarchyNodes[word].z;
    lower = min(vec3(x.x, y.x, z.x), vec3(x.z, y.z, z.z));
    upper = max(vec3(x.y, y.y, z.y), vec3(x.w, y.w, z.w));
  }
}

void fit(uint node) {
  uvec2 children = hierarchyNodes[node].children.xy;
  vec3 leftLower, leftUpper, rightLower, rightUpper;
  boundsOfChild(children.x, leftLower, leftUpper);
  boundsOfChild(children.y, rightLower, rightUpper);
  hierarchyNodes[node].x = vec4(leftLower.x, leftUpper.x, rightLower.x, rightUpper.x);
  hierarchyNodes[node].y = vec4(leftLower.y, leftUpper.y, rightLower.y, rightUpper.y);
  hierarchyNodes[node].z = vec4(leftLower.z, leftUpper.z, rightLower.z, rightUpper.z);
}

void fitRow(uvec4 nodes) {
  for (uint i = gl_LocalInvocationIndex; i < nodes.y; i += REFIT_GROUP) fit(nodes.x + i);
}

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= rowCount) return; // all of the group
  uvec4 row = refitRows[firstRow + number].nodes;
  if (!takesLists) {
    fitRow(row);
    return;
  }
  for (uint height = 0u; height < row.y; ++height) {
    fitRow(refitRows[row.x + height].nodes);
    memoryBarrierBuffer();
    barrier();
  }
}
