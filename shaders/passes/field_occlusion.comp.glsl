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
uniform ivec2 occlusionPlaces; // of a group

void main() {
  if (gl_LocalInvocationIndex == 0u) askedCount = 0u;
  barrier();
  ivec2 inGroup = ivec2(int(gl_LocalInvocationIndex) % occlusionPlaces.x, int(gl_LocalInvocationIndex) / occlusionPlaces.x);
  ivec2 place = ivec2(gl_WorkGroupID.xy) * occlusionPlaces + inGroup;
  bool isPlace = inGroup.y < occlusionPlaces.y && all(lessThan(place, imageSize(occlusion_traced))), isSurface = false;
  float t = 0.0;
  vec3 normal = vec3(0.0);
  uint own = 0u;
  if (isPlace) {
    ivec2 pixel = pixelOfTraced(place, occlusionScale, ivec2(frame.size.xy));
    isSurface = kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE;
    if (isSurface) {
      vec3 originEye, directionWorld;
      viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
      t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
      normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
      own = askOcclusion(originEye + t * directionWorld + frame.eyeAnchored.xyz, normal, cellOfTraced(place));
    }
  }
  barrier();
  traceAsked(OcclusionSearch(occlusionForm, occlusionCones, occlusionRadius));
  barrier();
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_OCCLUSION_READS], occlusionReads);
#endif
  if (!isPlace) return;
  uvec2 code = isSurface ? codeOfOcclusion(openOfAsked(own), t, normal) : OCCLUSION_OF_SKY;
  imageStore(occlusion_traced, place, uvec4(code, 0u, 0u));
}
