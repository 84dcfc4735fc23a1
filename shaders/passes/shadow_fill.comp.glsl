// From shadows at half resolution to those of all pixels, a thread a square: a pixel between those that were marched
// takes what its neighbours on the same plane say. Where there are none, or they disagree, it is listed to be marched.
#include "lib/shadow_squares.glsl"
#include "lib/shadowed_pixel.glsl"
#include "lib/work_list_append.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kShadowHalfUnit) uniform sampler2D shadow_half_read;
layout(binding = 0, rgba8) writeonly uniform image2D shadow;
#ifdef COUNTERS_ON
layout(binding = 1, r32ui) writeonly uniform uimage2D shadow_reads;
#endif

uniform uint squaresOfGroup; // of the dispatch that marches

// The marched pixels at a square's corners.
ShadowedPixel marched[4];
vec4 marchedVisible[4];

// Of the neighbours that were marched. False: none is on the pixel's plane, or they are too far apart.
//
// number  of the pixel in its square; its neighbours are those along the axes that it is off the first of them
bool fillPixel(ShadowedPixel surface, int number, out vec4 visible) {
  const float MOST_DIFFERENCE = 0.1;
  vec4 sum = vec4(0.0), least = vec4(1.0), most = vec4(0.0);
  float weights = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    int i = corner & number;
    if (marched[i].isSurface != surface.isSurface) continue;
    if (surface.isSurface && !isOnPlane(surface, marched[i].pointEye, marched[i].normal)) continue;
    sum += marchedVisible[i];
    weights += 1.0;
    least = min(least, marchedVisible[i]);
    most = max(most, marchedVisible[i]);
  }
  visible = sum / max(weights, 1.0);
  return weights > 0.0 && all(lessThan(most - least, vec4(MOST_DIFFERENCE)));
}

void main() {
  ivec2 square = ivec2(gl_GlobalInvocationID.xy), last = textureSize(shadow_half_read, 0) - 1;
  uint open = 0u;
  if (all(lessThanEqual(square, last))) {
    for (int i = 0; i < 4; ++i) {
      ivec2 at = min(square + ivec2(i & 1, i >> 1), last);
      marched[i] = shadowedPixel(2 * at);
      marchedVisible[i] = texelFetch(shadow_half_read, at, 0);
    }
    for (int number = 0; number < 4; ++number) {
      ivec2 pixel = pixelOfSquare(square, number);
      if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) continue;
      ShadowedPixel surface = marched[0];
      if (number > 0) surface = shadowedPixel(pixel);
      vec4 visible = marchedVisible[0];
      if (number > 0 && !fillPixel(surface, number, visible)) {
        open |= 1u << uint(number);
        continue;
      }
      imageStore(shadow, pixel, visible);
#ifdef COUNTERS_ON
      if (number > 0) imageStore(shadow_reads, pixel, uvec4(0u));
#endif
    }
  }
  appendWork(open != 0u, entryOfSquare(square, open), squaresOfGroup);
}
