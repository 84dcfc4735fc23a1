// Fills a list of work; the host has set its command to no groups.
#include "lib/work_list.glsl"

shared uint appendedByGroup, firstOfGroup;

// For all threads of a group at once: appends the entries of those that have one, in no order.
//
// entriesOfGroup  that a group of the next dispatch takes
void appendWork(bool isWanted, uint entry, uint entriesOfGroup) {
  if (gl_LocalInvocationIndex == 0u) appendedByGroup = 0u;
  barrier();
  uint place = isWanted ? atomicAdd(appendedByGroup, 1u) : 0u;
  barrier();
  if (gl_LocalInvocationIndex == 0u && appendedByGroup > 0u) {
    firstOfGroup = atomicAdd(workCount, appendedByGroup);
    uint groups = (firstOfGroup + appendedByGroup + entriesOfGroup - 1u) / entriesOfGroup;
    atomicMax(workGroups.x, min(groups, MOST_WORK_GROUPS));
    atomicMax(workGroups.y, (groups + MOST_WORK_GROUPS - 1u) / MOST_WORK_GROUPS);
  }
  barrier();
  if (isWanted) work[firstOfGroup + place] = entry;
}
