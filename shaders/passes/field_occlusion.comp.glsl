// Ambient occlusion from the world field at every scale-th pixel, for occlusion_spread.comp.glsl to make a picture of.
#include "lib/gbuffer.glsl"
#include "lib/occlusion_code.glsl"
#include "lib/occlusion_group.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
#endif
layout(binding = 0, rg32ui) writeonly uniform uimage2D occlusion_traced;

uniform int occlusionForm, occlusionCones, occlusionScale;
uniform float occlusionRadius;

#ifdef SIDE_BY_SIDE // where places are few: a thread a cone of eight
const ivec2 PLACES = ivec2(4, 2); // of a group
#else
const ivec2 PLACES = ivec2(8, 8);
#endif

// A place's surface.
struct PlacePoint {
  bool isPlace, isSurface;
  ivec2 place;
  float t;
  vec3 origin, normal;
};

PlacePoint placePoint() {
  int own = int(gl_LocalInvocationIndex);
  ivec2 inGroup = ivec2(own % PLACES.x, own / PLACES.x), place = ivec2(gl_WorkGroupID.xy) * PLACES + inGroup;
  PlacePoint point = PlacePoint(false, false, place, 0.0, vec3(0.0), vec3(0.0));
  if (inGroup.y >= PLACES.y || any(greaterThanEqual(place, imageSize(occlusion_traced)))) return point;
  point.isPlace = true;
  ivec2 pixel = pixelOfTraced(place, occlusionScale, ivec2(frame.size.xy));
  if (kindOfId(texelFetch(id, pixel, 0).r) == KIND_NONE) return point;
  point.isSurface = true;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  point.t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
  point.origin = originEye + point.t * directionWorld + frame.eyeAnchored.xyz;
  point.normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
  return point;
}

float openShare(PlacePoint point, OcclusionSearch search) {
  uint cell = cellOfTraced(point.place);
#ifdef SIDE_BY_SIDE
  if (gl_LocalInvocationIndex == 0u) askedCount = 0u;
  barrier();
  uint own = point.isSurface ? askOcclusion(point.origin, point.normal, cell) : 0u;
  barrier();
  traceAsked(search);
  barrier();
  return openOfAsked(own);
#else
  if (!point.isSurface) return 1.0;
  OcclusionPoint from = occlusionPoint(point.origin, point.normal);
  float open = 0.0;
  for (int part = 0; part < partsOfOcclusion(search); ++part) open += openPart(from, search, cell, part);
  return open;
#endif
}

void main() {
  PlacePoint point = placePoint();
  float open = openShare(point, OcclusionSearch(occlusionForm, occlusionCones, occlusionRadius));
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_OCCLUSION_READS], occlusionReads);
#endif
  if (!point.isPlace) return;
  uvec2 code = point.isSurface ? codeOfOcclusion(open, point.t, point.normal) : OCCLUSION_OF_SKY;
  imageStore(occlusion_traced, point.place, uvec4(code, 0u, 0u));
}
