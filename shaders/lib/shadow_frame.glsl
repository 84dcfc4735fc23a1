// The frame of all passes that march shadows: which pixel, which lights, where the shares go, one channel a light. The
// pass that includes it says how much of a light is seen. With MAPS_DECIDE shadow maps answer first, and only what they
// are unsure of is marched.
//
// At half resolution every second pixel of every second row is marched first, then what shadow_fill.comp.glsl lists.
#include "lib/group_blocks.glsl"
#include "lib/shadow_cone.glsl"
#include "lib/shadow_region.glsl"
#include "lib/shadow_squares.glsl"
#include "lib/shadowed_pixel.glsl"
#include "lib/work_list.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = GROUP_WIDTH, local_size_y = GROUP_HEIGHT) in; // by whoever includes this: whole blocks

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
layout(binding = 0, rgba8) writeonly uniform image2D shadow; // of the step: all pixels, or every fourth
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
layout(binding = 1, r32ui) uniform uimage2D shadow_reads;
#endif

const uint STEP_ALL = 0u, STEP_HALF = 1u, STEP_LISTED = 2u;
uniform uint resolutionStep;

// How much of the light the cone leads to.
//
// cell  of the pixel, see partOfLight
float visibleShare(ShadowCone cone, int light, ivec2 pixel, int cell);
// Of what was asked last: it is the mean over parts of the light that the pixel's cell chose.
bool isOfCell();
// Distances that this thread read.
uint readsOfThread();

// Without an end.
ShadowCone coneTo(LightRow light, ShadowedPixel pixel) {
  ShadowCone cone;
  cone.origin = pixel.pointEye + frame.eyeAnchored.xyz;
  cone.normal = pixel.normal;
  cone.isRectangle = uint(light.position.w) == LIGHT_RECTANGLE;
  if (uint(light.position.w) == LIGHT_SUN) {
    cone.axis = -light.direction.xyz;
    cone.spread = light.intensity.w;
    cone.lightAt = 3.4e38;
  } else {
    vec3 way = light.position.xyz - frame.eyeWorld.xyz - pixel.pointEye;
    float away = max(length(way), 1e-6), radius = light.intensity.w;
    cone.axis = way / away;
    cone.lightAt = away;
    cone.spread = cone.isRectangle ? radius / away : radius * inversesqrt(max(away * away - radius * radius, 0.01 * radius * radius));
  }
  axesAcross(cone.axis, cone.right, cone.up);
  cone.right *= cone.spread;
  cone.up *= cone.spread;
  if (cone.isRectangle) {
    cone.right = light.cone.xyz / cone.lightAt;
    cone.up = normalize(cross(light.cone.xyz, light.direction.xyz)) * (light.cone.w / cone.lightAt);
  }
  return cone;
}

float marchLight(int number, ShadowCone cone, ivec2 pixel, int cell) {
  float before = cone.isRectangle ? 0.0 : lights[number].intensity.w; // the light begins
  cone.end = min(max(cone.lightAt - before, 0.0), leavesField(cone.origin, cone.axis, cone.spread));
  return visibleShare(cone, number, pixel, cell);
}

// pixelMetres  that a pixel spans on the surface, at most
// isWide       of which lights the penumbra there is so wide that a square of two by two pixels may share it
vec4 marchPixel(ivec2 pixel, int cell, ShadowedPixel surface, float pixelMetres, out bvec4 isWide) {
  vec4 visible = vec4(1.0);
  isWide = bvec4(false);
  if (!surface.isSurface) return visible;
  for (int i = 0; i < min(int(frame.size.z), MOST_SHADOWED_LIGHTS); ++i) {
    ShadowCone cone = coneTo(lights[i], surface);
    cone.pixel = pixelMetres;
#ifdef MAPS_DECIDE
    visible[i] = shareByMaps(i, cone, surface.pointEye);
    if (visible[i] != MAP_UNSURE) continue;
#endif
    visible[i] = marchLight(i, cone, pixel, cell);
    isWide[i] = isOfCell();
  }
  return visible;
}

// Along the surface away from the eye, where it is longest.
float pixelMetresOn(ShadowedPixel surface, ivec2 pixel) {
  const float LEAST_COSINE = 0.02;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  float across = 2.0 / (frame.projection.y * float(frame.size.y)) * (frame.projection.z > 0.5 ? 1.0 : surface.away);
  if (resolutionStep == STEP_HALF) across *= 2.0;
  return across / max(-dot(surface.normal, directionWorld), LEAST_COSINE);
}

// Of a square of two by two pixels, each of which asked for other parts of the lights, the mean of those on the pixel's
// plane whose penumbrae are wide; what is sharp stays so.
//
// A square is of threads whose numbers differ by 1 and by a block's row; of listed ones, of four in a row.
const uint GROUP_THREADS = uint(GROUP_WIDTH * GROUP_HEIGHT);
shared uvec2 squareVisible[GROUP_THREADS]; // 16 bits each
shared vec4 squarePoint[GROUP_THREADS];    // eye space; w: a bit for each light whose penumbra is wide
shared uint squareNormal[GROUP_THREADS];   // octahedral

vec4 meanOfSquare(ShadowedPixel surface, vec4 visible, bvec4 isWide) {
  uint own = gl_LocalInvocationIndex;
  squareVisible[own] = uvec2(packUnorm2x16(visible.xy), packUnorm2x16(visible.zw));
  squarePoint[own] = vec4(surface.pointEye, dot(vec4(isWide), vec4(1.0, 2.0, 4.0, 8.0)));
  squareNormal[own] = packSnorm2x16(octahedralFromDirection(surface.normal));
  barrier();
  vec4 sum = visible, weights = vec4(1.0);
  uint nextRow = resolutionStep == STEP_LISTED ? 2u : uint(BLOCK_WIDTH);
  for (uint i = 1u; i < 4u; ++i) {
    uint other = own ^ ((i & 1u) + nextRow * (i >> 1));
    int bits = int(squarePoint[other].w);
    if (bits == 0 || !any(isWide)) continue;
    vec3 normal = directionFromOctahedral(unpackSnorm2x16(squareNormal[other]));
    if (!isOnPlane(surface, squarePoint[other].xyz, normal)) continue;
    vec4 weight = vec4(isWide) * vec4(bits & 1, bits >> 1 & 1, bits >> 2 & 1, bits >> 3 & 1);
    sum += weight * vec4(unpackUnorm2x16(squareVisible[other].x), unpackUnorm2x16(squareVisible[other].y));
    weights += weight;
  }
  return sum / weights;
}

// Which pixel of the image is this thread's. False: none.
bool ownPlace(out ivec2 at) {
  if (resolutionStep != STEP_LISTED) {
    at = ivec2(gl_WorkGroupID.xy) * ivec2(GROUP_WIDTH, GROUP_HEIGHT) + placeInBlocks(GROUP_WIDTH);
    return all(lessThan(at, imageSize(shadow)));
  }
  uint thread = numberOfGroup() * GROUP_THREADS + gl_LocalInvocationIndex, entry = thread / 4u < workCount ? work[thread / 4u] : 0u;
  int number = int(thread % 4u);
  at = pixelOfSquare(squareOfEntry(entry), number);
  return isMarched(entry, number);
}

void main() {
  ivec2 at;
  bool isOwn = ownPlace(at);
  ivec2 pixel = resolutionStep == STEP_HALF ? 2 * at : at;
  ShadowedPixel surface = ShadowedPixel(vec3(0.0), vec3(0.0), 0.0, false);
  vec4 visible = vec4(1.0);
  bvec4 isWide = bvec4(false);
  if (isOwn) {
    surface = shadowedPixel(pixel);
    visible = marchPixel(pixel, (at.x & 1) + 2 * (at.y & 1), surface, pixelMetresOn(surface, pixel), isWide);
  }
  visible = meanOfSquare(surface, visible, isWide);
  if (!isOwn) return;
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_SHADOW_READS], readsOfThread());
  imageStore(shadow_reads, pixel, uvec4(readsOfThread()));
#endif
  imageStore(shadow, at, visible);
}
