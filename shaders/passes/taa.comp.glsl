// Temporal antialiasing: each frame samples another place of its pixels; what was seen there before is fetched along the
// motion vectors, held to what the neighbours say now, and averaged in. Variance clipping after Salvi (2016), in YCoCg;
// the nearest surface of 3x3 leads, so that moving edges stay smooth.
#include "lib/gbuffer.glsl"
#include "lib/motion.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kColorUnit) uniform sampler2D color;
layout(binding = kMotionUnit) uniform sampler2D motion;
layout(binding = kHistoryUnit) uniform sampler2D history;
layout(binding = kHistoryDepthUnit) uniform sampler2D history_depth;
layout(binding = 0, rgba16f) writeonly uniform image2D history_now;
layout(binding = 1, r32f) writeonly uniform image2D depth_now;

uniform bool hasHistory;

const float kMostFrames = 64.0;       // in a pixel's average; as many as there are places in it
// The mean of an edge's samples lies within one deviation of any nine of them, or nearly; what stands still may be
// trusted farther, since a wrong history of a flat surface is many deviations off.
const float kClipSigmas = 1.25, kClipSigmasStill = 3.0;
const float kNearerShare = 0.02;      // a depth before must be nearer by this to have hidden what is seen now
const float SKY_DEPTH = 3e38;

// What differs in brightness by hundreds would make variance mean nothing.
vec3 compressed(vec3 c) { return c / (1.0 + max(c.r, max(c.g, c.b))); }
vec3 expanded(vec3 c) { return c / max(1.0 - max(c.r, max(c.g, c.b)), 1e-4); }
vec3 ycocgOf(vec3 c) { return vec3(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * (c.r - c.b), 0.5 * c.g - 0.25 * (c.r + c.b)); }
vec3 rgbOf(vec3 y) { return vec3(y.x + y.y - y.z, y.x + y.z, y.x - y.y - y.z); }

float depthAt(ivec2 pixel) {
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  float stored = texelFetch(depth, pixel, 0).r;
  if (stored <= 0.0) return SKY_DEPTH;
  float t = rayParameterOfDepth(originEye, directionWorld, stored);
  return viewDepth(frame.clipFromEye * vec4(originEye + t * directionWorld, 1.0));
}

// Bicubic (Catmull-Rom) by nine bilinear reads: a history that is fetched bilinearly sixty times is blurred.
vec4 sampleHistory(vec2 place) {
  vec2 size = vec2(frame.size.xy), center = floor(place - 0.5) + 0.5, f = place - center;
  vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f)), w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
  vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f)), w3 = f * f * (-0.5 + 0.5 * f);
  vec2 w12 = w1 + w2;
  vec2 at[3] = vec2[](center - 1.0, center + w2 / w12, center + 2.0);
  vec2 w[3] = vec2[](w0, w12, w3);
  vec4 sum = vec4(0.0);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) sum += w[x].x * w[y].y * textureLod(history, vec2(at[x].x, at[y].y) / size, 0.0);
  return sum;
}

// All that was seen around that place lay before what is seen now: it was hidden.
bool wasHidden(vec2 place, float expectedDepth) {
  ivec2 center = ivec2(floor(place)), last = ivec2(frame.size.xy) - 1;
  float limit = expectedDepth >= SKY_DEPTH ? 1e37 : expectedDepth * (1.0 - kNearerShare);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      if (texelFetch(history_depth, clamp(center + ivec2(x, y), ivec2(0), last), 0).r >= limit) return false;
  return true;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  ivec2 last = ivec2(frame.size.xy) - 1, leading = pixel;
  float ownDepth = depthAt(pixel), nearest = ownDepth;
  vec3 mean = vec3(0.0), squares = vec3(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
      vec3 c = ycocgOf(compressed(texelFetch(color, at, 0).rgb));
      mean += c / 9.0, squares += c * c / 9.0;
      float d = depthAt(at);
      if (d < nearest) nearest = d, leading = at;
    }
  vec3 own = texelFetch(color, pixel, 0).rgb;
  imageStore(depth_now, pixel, vec4(ownDepth));

  vec3 moved = texelFetch(motion, leading, 0).rgb, ownMoved = texelFetch(motion, pixel, 0).rgb;
  vec2 place = vec2(pixel) + 0.5 - moved.xy;
  bool isInside = all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, vec2(frame.size.xy)));
  float expected = ownDepth >= SKY_DEPTH ? SKY_DEPTH : ownDepth * ownMoved.z;
  if (!hasHistory || !isInside || wasHidden(vec2(pixel) + 0.5 - ownMoved.xy, expected)) {
    imageStore(history_now, pixel, vec4(own, 1.0));
    return;
  }
  bool isStill = dot(moved.xy, moved.xy) < 1e-6;
  vec4 before = isStill ? texelFetch(history, pixel, 0) : sampleHistory(place);
  before.rgb = max(before.rgb, vec3(0.0));
  vec3 sigma = sqrt(max(squares - mean * mean, vec3(0.0))) * (isStill ? kClipSigmasStill : kClipSigmas);
  vec3 c = ycocgOf(compressed(before.rgb)), away = c - mean;
  // Towards the mean until it is in the box.
  vec3 ratios = abs(away) / max(sigma, vec3(1e-5));
  float over = max(ratios.x, max(ratios.y, ratios.z));
  if (over > 1.0) before.rgb = max(expanded(rgbOf(mean + away / over)), vec3(0.0));
  // What had to be clipped by far is no average of this surface: fewer frames count.
  float frames = min(clamp(round(before.a), 1.0, kMostFrames) / max(1.0, over * over), kMostFrames - 1.0);
  imageStore(history_now, pixel, vec4(mix(before.rgb, own, 1.0 / (floor(frames) + 1.0)), floor(frames) + 1.0));
}
