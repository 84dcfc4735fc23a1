// The open shares of the few points that a group asks for, a thread a part: one after the other a point's parts take as
// long as they are many, which is right where there are points enough for all threads.
#include "lib/field_occlusion.glsl"

const uint OCCLUSION_GROUP = 64u; // threads
const float OPEN_UNIT = 1048576.0; // whole numbers add up to the same in any order

shared uint askedCount; // one thread zeroes it before a barrier
shared OcclusionPoint askedPoint[OCCLUSION_GROUP];
shared uint askedCell[OCCLUSION_GROUP]; // of the pattern
shared uint askedOpen[OCCLUSION_GROUP];

// A point a thread at most.
//
// returns its number for openOfAsked
uint askOcclusion(vec3 origin, vec3 normal, uint cell) {
  uint own = atomicAdd(askedCount, 1u);
  askedPoint[own] = occlusionPoint(origin, normal);
  askedCell[own] = cell;
  askedOpen[own] = 0u;
  return own;
}

// By all threads, after a barrier.
void traceAsked(OcclusionSearch search) {
  uint parts = uint(partsOfOcclusion(search));
  for (uint i = gl_LocalInvocationIndex; i < askedCount * parts; i += OCCLUSION_GROUP) {
    uint asked = i / parts;
    float open = openPart(askedPoint[asked], search, askedCell[asked], int(i % parts));
    atomicAdd(askedOpen[asked], uint(round(clamp(open, 0.0, 1.0) * OPEN_UNIT)));
  }
}

// After another barrier.
float openOfAsked(uint own) { return float(askedOpen[own]) / OPEN_UNIT; }
