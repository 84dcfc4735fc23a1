// A level of the pyramid over all shadow maps: of each square of two by two the depths nearest to the light (x) and
// farthest (y). The last square of an odd side holds three texels along it. Levels lie one above the other, level l from
// the row side - side / 2^l on, and are no mipmaps: their readers ask for another one in each thread, which Mesa's
// software renderer answers for four threads at once.
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kShadowMapUnit) uniform sampler2DArray shadow_map;
layout(binding = kShadowRangeUnit) uniform sampler2DArray shadow_range;
layout(binding = 0, rg32f) writeonly uniform image2DArray result;

uniform int levelIndex; // that is written; 0: from the maps

vec2 rangeAt(ivec3 texel, int side) {
  if (levelIndex == 0) return texelFetch(shadow_map, texel, 0).rr;
  return texelFetch(shadow_range, texel + ivec3(0, side - (side >> (levelIndex - 1)), 0), 0).xy;
}

void main() {
  int side = textureSize(shadow_map, 0).x;
  ivec3 at = ivec3(gl_GlobalInvocationID), size = ivec3(ivec2(side >> (levelIndex + 1)), imageSize(result).z);
  if (any(greaterThanEqual(at, size))) return;
  ivec2 from = ivec2(side >> levelIndex), low = 2 * at.xy;
  ivec2 high = mix(low + 1, from - 1, equal(at.xy, size.xy - 1));
  vec2 range = vec2(0.0, 1.0);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      vec2 of = rangeAt(ivec3(x, y, at.z), side);
      range = vec2(max(range.x, of.x), min(range.y, of.y));
    }
  imageStore(result, ivec3(at.x, at.y + side - (side >> levelIndex), at.z), vec4(range, 0.0, 0.0));
}
