// A pixel as shadows see it.
#include "lib/gbuffer.glsl"

struct ShadowedPixel {
  vec3 pointEye;
  vec3 normal;
  float away; // from the eye, metres
  bool isSurface;
};

ShadowedPixel shadowedPixel(ivec2 pixel) {
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
  vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
  return ShadowedPixel(originEye + t * directionWorld, normal, t, kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE);
}

bool isOnPlane(ShadowedPixel surface, vec3 pointEye, vec3 normal) {
  const float PLANE = 0.004, SAME_NORMAL = 0.96;
  return dot(surface.normal, normal) >= SAME_NORMAL && abs(dot(surface.normal, pointEye - surface.pointEye)) <= PLANE * surface.away;
}
