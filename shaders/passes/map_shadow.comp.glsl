// Shadows of the first lights by their maps, one channel a light.
#include "lib/gbuffer.glsl"
#include "lib/shadow_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
layout(binding = 0, rgba8) writeonly uniform image2D shadow;

uniform int shadowFilter; // SHADOW_FILTER_*

float visibleShare(int light, vec3 pointEye, vec3 normal) {
  LightRow row = lights[light];
  bool isSun = uint(row.position.w) == LIGHT_SUN;
  vec3 toLight = isSun ? -row.direction.xyz : row.position.xyz - frame.eyeWorld.xyz - pointEye;
  if (dot(normal, toLight) <= 0.0) return 0.0;
  MapPoint point = mapPointAt(shadowMaps.lights[light], pointEye, normal);
  if (point.layer < 0) return 1.0;
  return shadowFilter == SHADOW_FILTER_EVSM ? filterEvsm(point) : filterPcf(point);
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
    for (int i = 0; i < min(int(frame.size.z), MOST_SHADOWED_LIGHTS); ++i)
      visible[i] = visibleShare(i, originEye + t * directionWorld, normal);
  }
  imageStore(shadow, pixel, visible);
}
