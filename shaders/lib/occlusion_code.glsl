// What is traced at a place of the smaller picture of occlusion: the open share, the ray's way to the surface and its
// normal, so that spreading it over the picture needs no other reads.
#include "lib/octahedral.glsl"
#include "shared/field_occlusion_params.h"

const uvec2 OCCLUSION_OF_SKY = uvec2(0u, 0x7f800000u); // infinitely far

struct TracedOcclusion {
  float open;
  float t; // metres along the view ray
  vec3 normal;
};

// Eight bits of share over twelve for each of the normal's two numbers.
uvec2 codeOfOcclusion(float open, float t, vec3 normal) {
  uvec2 oct = uvec2(round((octahedralFromDirection(normal) * 0.5 + 0.5) * 4095.0));
  return uvec2(uint(round(clamp(open, 0.0, 1.0) * 255.0)) << 24 | oct.x << 12 | oct.y, floatBitsToUint(t));
}

TracedOcclusion occlusionOfCode(uvec2 code) {
  vec2 oct = vec2(code.x >> 12 & 4095u, code.x & 4095u) / 4095.0 * 2.0 - 1.0;
  return TracedOcclusion(float(code.x >> 24) / 255.0, uintBitsToFloat(code.y), directionFromOctahedral(oct));
}

// The pixel in the middle of a place's square.
ivec2 pixelOfTraced(ivec2 place, int scale, ivec2 size) { return min(place * scale + scale / 2, size - 1); }

uint cellOfTraced(ivec2 place) {
  ivec2 cell = place & (OCCLUSION_PATTERN_SIDE - 1);
  return uint(cell.y * OCCLUSION_PATTERN_SIDE + cell.x);
}
