// What both passes of motion blur know: how far a pixel smears while the shutter is open.
#include "lib/gbuffer.glsl"

layout(binding = kMotionUnit) uniform sampler2D motion;

const int MOTION_TILE = 16;

uniform float shutter; // of the time between two frames

// Half of the way, pixels; no longer than a tile is wide.
vec2 smearAt(ivec2 pixel) {
  vec2 way = 0.5 * shutter * texelFetch(motion, pixel, 0).xy;
  float pixels = length(way);
  return pixels > float(MOTION_TILE) ? way * (float(MOTION_TILE) / pixels) : way;
}
