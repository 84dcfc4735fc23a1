// Work that one dispatch leaves to the next: how many groups that takes, as the command of an indirect dispatch, and an
// entry for each piece. Few pixels need what is costly; as a list they fill warps, and the program that chooses them
// needs no more registers than that takes.
#include "shared/bindings.h"

layout(std430, binding = kWorkListBinding) buffer WorkListBlock {
  uvec3 workGroups;
  uint workCount;
  uint work[];
};

// As many groups OpenGL 4.5 promises along an axis; more lie in further rows.
const uint MOST_WORK_GROUPS = 65535u;

uint numberOfGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
