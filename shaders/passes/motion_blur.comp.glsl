// Motion blur from one picture: samples along the longest way that anything near a pixel smears, found by tiles (McGuire
// et al. 2012). Unlike there each stands for a moment at which the shutter is open: then a sample whose surface smears as
// far, and is not behind, has come to the pixel; else, where the pixel's own surface has left it, one farther away stands
// for what appears; else nothing has changed. So edges rise in straight lines.
#include "lib/motion_blur.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kColorUnit) uniform sampler2D color;
layout(binding = kMotionTileUnit) uniform sampler2D motion_tiles;
layout(binding = 0, rgba16f) writeonly uniform image2D blurred;

const int SAMPLES = 16;
const float STILL_PIXELS = 0.5; // what smears less stays as it is
const float SAME_DEPTH = 0.05;  // of the nearer one's: as much apart neither hides the other

float depthAt(ivec2 pixel) {
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  return rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
}

vec2 longestAround(ivec2 pixel) {
  ivec2 tile = pixel / MOTION_TILE, last = textureSize(motion_tiles, 0) - 1;
  vec2 longest = vec2(0.0);
  for (int i = 0; i < 9; ++i) {
    vec2 other = texelFetch(motion_tiles, clamp(tile + ivec2(i % 3, i / 3) - 1, ivec2(0), last), 0).rg;
    if (dot(other, other) > dot(longest, longest)) longest = other;
  }
  return longest;
}

// 1 where a lies before b or beside it, 0 where far behind.
float before(float a, float b) { return clamp(1.0 - (a - b) / (SAME_DEPTH * min(a, b)), 0.0, 1.0); }
// Whether what smears so far comes across a way.
float crosses(float way, float smear) { return 1.0 - smoothstep(0.95 * smear, 1.05 * smear, way); }

// Where in its step a pixel samples, so that steps show as grain (interleaved gradient noise, Jimenez 2014).
float grainAt(ivec2 pixel) { return fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715)))) - 0.5; }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), last = ivec2(frame.size.xy) - 1;
  if (any(greaterThan(pixel, last))) return;
  vec2 longest = longestAround(pixel);
  vec3 own = texelFetch(color, pixel, 0).rgb;
  if (length(longest) <= STILL_PIXELS) {
    imageStore(blurred, pixel, vec4(own, 1.0));
    return;
  }
  float ownSmear = max(length(smearAt(pixel)), STILL_PIXELS), ownDepth = depthAt(pixel);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < SAMPLES; ++i) {
    float part = (float(i) + 0.5 + 0.95 * grainAt(pixel)) / float(SAMPLES) * 2.0 - 1.0;
    ivec2 at = clamp(ivec2(floor(vec2(pixel) + 0.5 + part * longest)), ivec2(0), last);
    float way = length(part * longest), itsDepth = depthAt(at);
    float comes = crosses(way, max(length(smearAt(at)), STILL_PIXELS)) * before(itsDepth, ownDepth);
    float leaves = crosses(way, ownSmear) * before(ownDepth, itsDepth);
    sum += mix(own, texelFetch(color, at, 0).rgb, max(comes, leaves));
  }
  imageStore(blurred, pixel, vec4(sum / float(SAMPLES), 1.0));
}
