// Soft shadows of the first lights by the world field, one channel a light.
#include "lib/field_shadow.glsl"
#include "lib/gbuffer.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
#endif
layout(binding = 0, rgba8) writeonly uniform image2D shadow;

uniform int raysOfPenumbra;

// From a point, given from the eye.
ShadowCone coneTo(LightRow light, vec3 pointEye, vec3 normal) {
  ShadowCone cone;
  cone.origin = pointEye + frame.eyeAnchored.xyz;
  cone.normal = normal;
  int cascade = readWorldField(cone.origin).cascade;
  cone.texel = field.cascades[cascade < 0 ? int(field.counts.x) - 1 : cascade].texel.x;
  if (uint(light.position.w) == LIGHT_SUN) {
    cone.axis = -light.direction.xyz;
    cone.spread = light.intensity.w;
    cone.end = 3.4e38;
    return cone;
  }
  vec3 way = light.position.xyz - frame.eyeWorld.xyz - pointEye;
  float away = max(length(way), 1e-6);
  cone.axis = way / away;
  cone.spread = light.intensity.w / away;
  cone.end = max(away - light.intensity.w, 0.0);
  return cone;
}

// Beyond the field nothing blocks: where the way leaves the box of the coarsest window.
float leavesField(vec3 origin, vec3 direction) {
  FieldCascade coarsest = field.cascades[int(field.counts.x) - 1];
  vec3 low = vec3(coarsest.window.xyz) * coarsest.texel.x, high = low + float(coarsest.window.w) * coarsest.texel.x;
  vec3 ends = mix(low, high, greaterThan(direction, vec3(0.0))) - origin;
  vec3 far = mix(ends / direction, vec3(3.4e38), lessThan(abs(direction), vec3(1e-7)));
  return max(min(far.x, min(far.y, far.z)), 0.0);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec4 visible = vec4(1.0);
  if (kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE) {
    vec3 originEye, directionWorld;
    viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
    float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
    vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
    for (int i = 0; i < min(int(frame.size.z), MOST_SHADOWED_LIGHTS); ++i) {
      ShadowCone cone = coneTo(lights[i], originEye + t * directionWorld, normal);
      cone.end = min(cone.end, leavesField(cone.origin, cone.axis));
      visible[i] = shadowOf(cone, raysOfPenumbra);
    }
  }
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_SHADOW_READS], shadowReads);
#endif
  imageStore(shadow, pixel, visible);
}
