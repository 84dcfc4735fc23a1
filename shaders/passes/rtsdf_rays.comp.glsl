// The fine field of the RTSDF paper, sections 2.1 to 2.5. Per texel of the field whose coarse distance c lies within
// the mask: x rays in uniformly random directions, the distance r of the nearest hit (infinite without one), a vote of
// front against back faces; then equation 1. Outside the mask the field is c, hollow inside of things as the paper says.
//
// What the paper leaves open, and what is chosen:
// - How c is read at fine texels: by trilinear interpolation, which it names as the advantage of uniform grids.
// - What the sign of r does in equation 1. A signed r would let the minimum prefer the deepest hit inside of things.
//   So equation 1 is done with the unsigned r, as c is unsigned, and the sign is put on the result. Section 2.2 may as
//   well be read as if beta alone made a sign: signByVote false.
// - How many rays vote. A majority of one ray is noise on open surfaces; section 2.1 sums votes over frames. Here votes
//   are summed over frames and fade by the same alpha as the distances, so what has moved away is forgotten alike.
// - f of the frame before the first: c.
// The faults of the formula stay: c is too short by up to half a coarse voxel's diagonal and beta,
// and the minimum keeps it; what has moved away fades by alpha a frame.
#include "shared/rtsdf_params.h"
#include "lib/triangle_hierarchy.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

// Kept from frame to frame, in the window's order.
layout(std430, binding = kRtsdfDistanceBinding) buffer DistanceBlock { float shortest[]; };
layout(std430, binding = kRtsdfVoteBinding) buffer VoteBlock { float votes[]; }; // front hits less back hits
#ifdef COUNTERS_ON
layout(std430, binding = kRtsdfCounterBinding) buffer CounterBlock { uint counters[]; };
#endif

layout(binding = kRtsdfCoarseUnit) uniform sampler3D coarseDistance;
layout(binding = kRtsdfFieldUnit, r16f) writeonly uniform image3D field;

uniform ivec3 extent;
uniform ivec3 firstSlot; // in the volume, of the window's first texel
uniform vec3 originAnchored;
uniform float texelSize;
uniform uint frameNumber;
uniform uint seed;
uniform uint raysPerTexel;
uniform float decay;
uniform float maskTexels;
uniform float biasTexels;
uniform float farthestTexels; // what stands for infinity in the field
uniform bool isFirst;
uniform bool bruteForce;
uniform bool signByVote;

// Jarzynski and Olano 2020, pcg4d: neighbouring counters give unrelated numbers.
uvec4 hashOf(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// Uniform on the sphere: the height is uniform (Archimedes), and so is the angle.
vec3 randomDirection(uint texel, uint ray) {
  vec2 unit = (vec2(hashOf(uvec4(texel, ray, frameNumber, seed)).xy >> 8u) + 0.5) / 16777216.0;
  float height = 1.0 - 2.0 * unit.x;
  float radius = sqrt(max(1.0 - height * height, 0.0));
  float angle = 6.28318530718 * unit.y;
  return vec3(radius * cos(angle), radius * sin(angle), height);
}

#ifdef COUNTERS_ON
void count(uint word, uint amount) {
  uint before = atomicAdd(counters[word], amount);
  if (before + amount < before) atomicAdd(counters[word + 1u], 1u);
}
#endif

struct RaySample {
  float nearest; // texels
  float votes;
};

RaySample sampleRays(ivec3 place, uint texel) {
  RaySample result = RaySample(kInfinity, 0.0);
  vec3 origin = originAnchored + (vec3(place) + 0.5) * texelSize;
  uint hits = 0u, nodeVisits = 0u, triangleTests = 0u;
  for (uint ray = 0u; ray < raysPerTexel; ++ray) {
    RayHit hit = traceHierarchy(origin, randomDirection(texel, ray), kInfinity);
    nodeVisits += hit.nodeVisits;
    triangleTests += hit.triangleTests;
    if (hit.triangle == HIERARCHY_NONE) continue;
    ++hits;
    result.nearest = min(result.nearest, hit.distance / texelSize);
    result.votes += hit.isFront ? 1.0 : -1.0;
  }
#ifdef COUNTERS_ON
  count(RTSDF_COUNT_TEXELS, 1u);
  count(RTSDF_COUNT_RAYS, raysPerTexel);
  count(RTSDF_COUNT_HITS, hits);
  count(RTSDF_COUNT_NODES, nodeVisits);
  count(RTSDF_COUNT_TRIANGLES, triangleTests);
#endif
  return result;
}

void main() {
  ivec3 place = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(place, extent))) return;
  uint texel = uint((place.z * extent.y + place.y) * extent.x + place.x);
  float distance, vote = 0.0;
  if (bruteForce) { // section 2.1: the least distance and all votes, for ever
    RaySample rays = sampleRays(place, texel);
    distance = isFirst ? rays.nearest : min(shortest[texel], rays.nearest);
    vote = isFirst ? rays.votes : votes[texel] + rays.votes;
  } else {
    float coarse = textureLod(coarseDistance, (vec3(place) + 0.5) / vec3(extent), 0.0).x;
    distance = coarse;
    if (abs(coarse) <= maskTexels) {
      RaySample rays = sampleRays(place, texel);
      float before = isFirst ? coarse : shortest[texel];
      distance = min(decay * before + (1.0 - decay) * coarse, rays.nearest); // equation 1
      vote = (isFirst ? 0.0 : decay * votes[texel]) + rays.votes;
    }
  }
  shortest[texel] = distance;
  votes[texel] = vote;
  float signedDistance = signByVote && vote < 0.0 ? -abs(distance) : distance;
  ivec3 slot = place + firstSlot;
  slot -= extent * ivec3(greaterThanEqual(slot, extent));
  imageStore(field, slot, vec4(clamp(signedDistance - biasTexels, -farthestTexels, farthestTexels)));
}
