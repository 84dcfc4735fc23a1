// Which SDF objects may be nearest in a tile of the world field; a group works on one tile. The work group's size must
// be declared before.
#include "lib/field_object_join.glsl"

// Of one round: objects are asked as many at a time as there are threads while all of them would have room.
const uint MOST_REACHING = gl_WorkGroupSize.x + 96u;
shared uvec2 reaching[MOST_REACHING]; // distance from the tile, float bits; number
shared uvec2 nearestFirst[MOST_REACHING];
shared uint reachingCount;
shared uint farthestBits; // largest value in the tile, metres

// Lists those of the next objects that may be nearer than `most` to a texel of the tile, or around it.
// returns the first that was not asked
uint listObjects(Place place, uint first, float most) {
  if (gl_LocalInvocationIndex == 0u) reachingCount = 0u;
  barrier();
  while (first < field.counts.z && reachingCount + gl_WorkGroupSize.x <= MOST_REACHING) {
    barrier(); // all have read the count
    uint number = first + gl_LocalInvocationIndex;
    float reach = most + place.halfDiagonal;
    if (number < field.counts.z) {
      vec4 sphere = objectRows[number].sphere;
      if (distance(sphere.xyz, place.tileCenter) - sphere.w < reach) {
        float least = max(boxDistance(objectAt(place, number), place.tileCenter) - place.halfDiagonal, 0.0);
        if (least <= most) reaching[atomicAdd(reachingCount, 1u)] = uvec2(floatBitsToUint(least), number);
      }
    }
    barrier();
    first += gl_WorkGroupSize.x;
  }
  barrier();
  for (uint own = gl_LocalInvocationIndex; own < reachingCount; own += gl_WorkGroupSize.x) {
    uint rank = 0u;
    uvec2 it = reaching[own];
    for (uint i = 0u; i < reachingCount; ++i) {
      uvec2 other = reaching[i];
      rank += uint(other.x < it.x || (other.x == it.x && other.y < it.y));
    }
    nearestFirst[rank] = it;
  }
  barrier();
  return first;
}
