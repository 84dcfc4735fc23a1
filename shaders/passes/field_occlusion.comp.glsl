// Ambient occlusion from the world field at every scale-th pixel, for occlusion_spread.comp.glsl to make a picture of.
#include "lib/field_occlusion.glsl"
#include "lib/gbuffer.glsl"
#include "lib/occlusion_code.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
#endif
layout(binding = 0, rg32ui) writeonly uniform uimage2D occlusion_traced;

uniform int occlusionForm, occlusionCones, occlusionScale;
uniform float occlusionRadius;

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(place, imageSize(occlusion_traced)))) return;
  ivec2 pixel = pixelOfTraced(place, occlusionScale, ivec2(frame.size.xy));
  uvec2 code = OCCLUSION_OF_SKY;
  if (kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE) {
    vec3 originEye, directionWorld;
    viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
    float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
    vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
    vec3 origin = originEye + t * directionWorld + frame.eyeAnchored.xyz;
    OcclusionSearch search = OcclusionSearch(occlusionForm, occlusionCones, occlusionRadius);
    code = codeOfOcclusion(openShare(origin, normal, search, cellOfTraced(place)), t, normal);
  }
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_OCCLUSION_READS], occlusionReads);
#endif
  imageStore(occlusion_traced, place, uvec4(code, 0u, 0u));
}
