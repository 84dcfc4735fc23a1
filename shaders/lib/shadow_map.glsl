// What shadow maps say of a point: which layer holds it, where it lies there, and the share of a light that a filter
// leaves it. Depths are reverse Z, larger is nearer to the light.
//
// A map's texel holds the depth at its centre, so a point is compared there with the plane of its own surface:
//
//      |   | . |        plane of the surface through the point p; at the texel's centre c it has another depth, by which
//      | p c   |        the stored one is judged. On a flat surface both are the same but for rounding: no acne, and no
//      .   |   |        bias by slope that would push shadows away from what casts them.
#include "lib/frame.glsl"
#include "lib/shadow_moments.glsl"
#include "shared/shadow_map_params.h"

layout(std140, binding = kShadowMapUniformBinding) uniform ShadowMapBlock { ShadowMapParams shadowMaps; };
layout(binding = kShadowMapUnit) uniform sampler2DArray shadow_map;
layout(binding = kShadowMomentsUnit) uniform sampler2DArray shadow_moments;

// Curved surfaces are made of flat triangles, whose planes the smooth normals miss: the point is lifted by this much.
const float kLiftTexels = 0.5;
// For rounding, and for corners that rasterizers move by a 256th of a texel.
const float kBiasTexels = 0.02;
// Of the depth's slope, texels of depth a texel: beyond, light grazes and the plane's depth is mostly rounding.
const float kMostSlope = 64.0;
const int kMarginTexels = SHADOW_BLUR_RADIUS + 1; // that filters read around a point

struct MapPoint {
  int layer;      // -1: no map holds it
  vec2 texel;     // where, texels
  float depth;
  vec2 slope;     // of the surface's depth, a texel
  float bias;     // in depth
  float share;    // of the layer's way from near to far end
  float texelShare; // a texel's size as such a share
};

vec3 eyeOfLayer(int layer, vec3 pointEye) {
  return pointEye + (frame.eyeWorld.xyz - shadowMaps.layers[layer].eyeWorld.xyz);
}

// Within the layer, with room for the filters.
bool isInLayer(int layer, vec3 pointEye) {
  vec4 clip = shadowMaps.layers[layer].clipFromEye * vec4(eyeOfLayer(layer, pointEye), 1.0);
  float inner = 1.0 - 2.0 * float(kMarginTexels) / float(shadowMaps.size.x);
  return clip.w > 0.0 && all(lessThanEqual(abs(clip.xy), vec2(inner * clip.w)));
}

// The finest layer of a light that holds a point, or -1.
int layerAt(ShadowMapLight light, vec3 pointEye) {
  if (light.layers.z == SHADOW_LAYOUT_CUBE) {
    vec3 way = eyeOfLayer(light.layers.x, pointEye), size = abs(way);
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return light.layers.x + 2 * axis + (way[axis] >= 0.0 ? 0 : 1);
  }
  for (int i = 0; i < light.layers.y; ++i)
    if (isInLayer(light.layers.x + i, pointEye)) return light.layers.x + i;
  return -1;
}

MapPoint mapPointIn(int number, vec3 pointEye, vec3 normal) {
  MapPoint point;
  point.layer = number;
  ShadowMapLayer layer = shadowMaps.layers[number];
  bool parallel = layer.depth.z > 0.5;
  vec3 p = eyeOfLayer(point.layer, pointEye);
  float texel = layer.eyeWorld.w * (parallel ? 1.0 : dot(layer.clipFromEye * vec4(p, 1.0), vec4(0, 0, 0, 1)));
  p += kLiftTexels * texel * normal;
  vec4 clip = layer.clipFromEye * vec4(p, 1.0);
  float side = float(shadowMaps.size.x);
  point.texel = (0.5 + 0.5 * clip.xy / clip.w) * side;
  point.depth = clip.z / clip.w;
  float depthPerMetre = parallel ? 1.0 / layer.depth.y : point.depth / clip.w;
  // A plane is a row: it goes to clip space by the inverse of what carries points there.
  vec4 plane = vec4(normal, -dot(normal, p)) * layer.eyeFromClip;
  float steep = kMostSlope * texel * depthPerMetre;
  point.slope = clamp(-plane.xy / plane.z * 2.0 / side, -steep, steep);
  point.bias = (texel * depthPerMetre + abs(point.slope.x) + abs(point.slope.y)) * kBiasTexels;
  float way = parallel ? 1.0 - point.depth : (clip.w - layer.depth.x) / (layer.depth.y - layer.depth.x);
  point.share = clamp(way, 0.0, 1.0);
  point.texelShare = texel / (layer.depth.y - layer.depth.x);
  return point;
}

MapPoint mapPointAt(ShadowMapLight light, vec3 pointEye, vec3 normal) {
  int number = light.layers.y == 0 ? -1 : layerAt(light, pointEye);
  if (number >= 0) return mapPointIn(number, pointEye, normal);
  MapPoint none;
  none.layer = -1;
  return none;
}

// Whether a texel's depth lies before the point's surface.
bool isTexelCovered(MapPoint point, ivec2 texel) {
  texel = clamp(texel, ivec2(0), ivec2(shadowMaps.size.x - 1));
  float mine = point.depth + dot(point.slope, vec2(texel) + 0.5 - point.texel);
  return texelFetch(shadow_map, ivec3(texel, point.layer), 0).r > mine + point.bias;
}

// Percentage-closer filtering (Reeves and others 1987): of a square of three texels around the point, the share whose
// depths do not cover it. The outer rows count by the part that the square has of them.
float filterPcf(MapPoint point) {
  vec2 corner = point.texel - 0.5;
  ivec2 first = ivec2(floor(corner)) - 1;
  vec2 f = fract(corner);
  float lit = 0.0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      vec2 weight = vec2(x == 0 ? 1.0 - f.x : x == 3 ? f.x : 1.0, y == 0 ? 1.0 - f.y : y == 3 ? f.y : 1.0);
      if (!isTexelCovered(point, first + ivec2(x, y))) lit += weight.x * weight.y;
    }
  return lit / 9.0;
}

float filterEvsm(MapPoint point) {
  vec4 moments = textureLod(shadow_moments, vec3(point.texel / float(shadowMaps.size.x), point.layer), 0.0);
  return litShare(moments, point.share, 0.5 * point.texelShare);
}
