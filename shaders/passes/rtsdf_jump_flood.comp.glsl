// One round of jump flooding in 3D (Rong and Tan 2006): each texel takes the nearest of the seeds that itself and its
// 26 neighbours at an offset know. The last round, offset 1, also writes the coarse field: distance between the
// centres of texel and seed, less beta. Flooding may miss the nearest seed by a little; it never names a texel that is
// none.
#include "shared/rtsdf_params.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;

layout(std430, binding = kRtsdfSeedBinding) readonly buffer SeedBlock { uint seeds[]; };
layout(std430, binding = kRtsdfSeedResultBinding) writeonly buffer ResultBlock { uint results[]; };

layout(binding = kRtsdfCoarseUnit, r32f) writeonly uniform image3D coarseDistance;

uniform int coarseSize;
uniform int offset;
uniform float texelsPerCoarse; // texels of the field
uniform float betaTexels;
uniform float farthestTexels; // where there is no seed at all

ivec3 placeOfSeed(uint seed) {
  return ivec3((uvec3(seed) >> uvec3(0u, RTSDF_SEED_BITS, 2u * RTSDF_SEED_BITS)) & RTSDF_SEED_MASK);
}

void main() {
  ivec3 place = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(place, ivec3(coarseSize)))) return;
  uint nearest = RTSDF_NO_SEED;
  int nearestSquare = 0x7fffffff;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        ivec3 other = place + offset * ivec3(x, y, z);
        if (any(lessThan(other, ivec3(0))) || any(greaterThanEqual(other, ivec3(coarseSize)))) continue;
        uint seed = seeds[(other.z * coarseSize + other.y) * coarseSize + other.x];
        if (seed == RTSDF_NO_SEED) continue;
        ivec3 apart = placeOfSeed(seed) - place;
        int square = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
        if (square < nearestSquare) {
          nearestSquare = square;
          nearest = seed;
        }
      }
  results[(place.z * coarseSize + place.y) * coarseSize + place.x] = nearest;
  if (offset > 1) return;
  float texels = nearest == RTSDF_NO_SEED ? farthestTexels : sqrt(float(nearestSquare)) * texelsPerCoarse;
  imageStore(coarseDistance, place, vec4(texels - betaTexels));
}
