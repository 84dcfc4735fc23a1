// What a shadow map says of the whole of a light and not only of its middle: nothing stands before any part of it, all
// of it is hidden, or neither for sure. A surface at a height above the point, towards the light, hides a part of the
// light if its texel is no farther from the point's own than the cone to the light is wide there:
//
//      \   |   /  cone from the point p to the light
//       \--|--/   what lies at this height counts between the dashes
//        \ | /
//   ______\p/_____
//
// Nearest and farthest depths of squares of texels (shadow_range.comp.glsl) bound both in few reads, from the highest
// surface downwards: each answer narrows the next question.
#include "lib/shadow_cone.glsl"
#include "lib/shadow_map.glsl"

layout(binding = kShadowRangeUnit) uniform sampler2DArray shadow_range;

const float MAP_UNSURE = -1.0;
// A half degree: lights that reach no farther around their middle are sharper than the world field's texels.
const float MAP_ALONE_SPREAD = 0.0088;
const int MAP_ROUNDS = 10;
// Around the point so few texels are compared one by one, each with the plane of the point's surface.
const float ONE_BY_ONE_TEXELS = 2.5;
// What hides the light at one height casts a penumbra of one width, which the map knows better than the field, where
// thin things are thick: heights that deviate by less than this part of their mean. What leans or stands on the ground
// beside the point has all heights, and is marched.
const float MOST_DEVIATION = 0.3;
const int SEARCH_TAPS = 16, FILTER_TAPS = 48;

// Level 0 has squares of two by two texels; shadow_range.comp.glsl says where levels lie.
vec2 rangeOfSquare(int layer, int level, ivec2 square) {
  int side = shadowMaps.size.x;
  return texelFetch(shadow_range, ivec3(square.x, square.y + side - (side >> level), layer), 0).xy;
}

// Texels around the point within which a surface of this depth hides a part of the light.
float reachAt(ShadowMapLayer layer, MapPoint point, ShadowCone cone, float surfaceDepth) {
  float span = layer.eyeWorld.w;
  if (layer.depth.z > 0.5) return cone.spread * max(surfaceDepth - point.depth, 0.0) * layer.depth.y / span;
  // By similar triangles, and stretched towards a map's corners as the light's disk stands askew to the map there.
  float mine = layer.depth.x / point.depth, other = layer.depth.x / surfaceDepth;
  return cone.spread * cone.lightAt * cone.lightAt / mine * max(mine - other, 0.0) / (mine * other * span);
}

// Whether the layer holds all texels within this reach.
bool isHeld(ShadowMapLayer layer, MapPoint point, float reach) {
  bool hasAll = layer.depth.w > 0.5; // beyond it there is nothing
  float side = float(shadowMaps.size.x);
  return hasAll || (all(greaterThan(point.texel, vec2(reach))) && all(lessThan(point.texel, vec2(side - reach))));
}

// Of the texels within a reach, and of some around them: the depths nearest to the light (x) and farthest (y).
// beyond  texels by which those around reach farther
vec2 rangeWithin(MapPoint point, float reach, out float beyond) {
  int level = clamp(int(ceil(log2(max(reach, 1.0)))) - 1, 0, shadowMaps.size.z - 1);
  float square = float(2 << level);
  beyond = square;
  ivec2 last = ivec2((shadowMaps.size.x >> (level + 1)) - 1);
  ivec2 low = clamp(ivec2(floor((point.texel - reach) / square)), ivec2(0), last);
  ivec2 high = clamp(ivec2(floor((point.texel + reach) / square)), ivec2(0), last);
  vec2 range = vec2(0.0, 1.0);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      vec2 of = rangeOfSquare(point.layer, level, ivec2(x, y));
      range = vec2(max(range.x, of.x), min(range.y, of.y));
    }
  return range;
}

// 1, 0 or MAP_UNSURE by each texel within the reach; half a texel more, for a texel is as wide as that to each side.
float oneByOne(MapPoint point, float reach) {
  ivec2 low = ivec2(floor(point.texel - reach - 0.5)), high = ivec2(floor(point.texel + reach + 0.5));
  int covered = 0, all = 0;
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      ++all;
      covered += int(isTexelCovered(point, ivec2(x, y)));
    }
  return covered == 0 ? 1.0 : covered == all ? 0.0 : MAP_UNSURE;
}

// Of four texels around a place the share that cover the point, interpolated; beside it their reach and its square,
// weighted so.
vec3 coveredAround(ShadowMapLayer layer, MapPoint point, ShadowCone cone, vec2 place) {
  vec2 corner = place - 0.5, f = fract(corner);
  ivec2 first = ivec2(floor(corner));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 way = ivec2(i & 1, i >> 1), texel = clamp(first + way, ivec2(0), ivec2(shadowMaps.size.x - 1));
    float stored = texelFetch(shadow_map, ivec3(texel, point.layer), 0).r;
    float mine = point.depth + dot(point.slope, vec2(texel) + 0.5 - point.texel);
    vec2 parts = mix(1.0 - f, f, vec2(way));
    float reach = reachAt(layer, point, cone, stored);
    if (stored > mine + point.bias) sum += parts.x * parts.y * vec3(1.0, reach, reach * reach);
  }
  return sum;
}

// Percentage-closer soft shadows (Fernando 2005): what covers the point within a reach says how wide a disk of texels is
// filtered; at least a texel, which is as sharp as a map can be. MAP_UNSURE where it says too many things.
float filterByHeight(ShadowMapLayer layer, MapPoint point, ShadowCone cone, float reach, bool isSmall) {
  ShadowCone disk = cone;
  disk.isRectangle = false;
  vec3 found = vec3(0.0);
  for (int i = 0; i < SEARCH_TAPS; ++i)
    found += coveredAround(layer, point, cone, point.texel + max(reach, 1.0) * partOfLight(disk, i, SEARCH_TAPS));
  if (found.x <= 0.0) return isSmall ? 1.0 : MAP_UNSURE;
  vec2 means = found.yz / found.x;
  float deviation = sqrt(max(means.y - means.x * means.x, 0.0));
  if (!isSmall && deviation > MOST_DEVIATION * means.x) return MAP_UNSURE;
  float width = max(means.x, 1.0), covered = 0.0;
  for (int i = 0; i < FILTER_TAPS; ++i)
    covered += coveredAround(layer, point, cone, point.texel + width * partOfLight(disk, i, FILTER_TAPS)).x;
  return 1.0 - covered / float(FILTER_TAPS);
}

// The visible share of a light by one layer that holds the point, or MAP_UNSURE.
float shareByLayer(ShadowMapLight light, MapPoint point, ShadowCone cone) {
  ShadowMapLayer layer = shadowMaps.layers[point.layer];
  float nearest = layer.depth.z > 0.5 ? 1.0 : 0.0;
  if (nearest == 0.0) // whatever stands nearest to the light, in its other faces too
    for (int i = 0; i < light.layers.y; ++i)
      nearest = max(nearest, rangeOfSquare(light.layers.x + i, shadowMaps.size.z - 1, ivec2(0)).x);
  float reach = reachAt(layer, point, cone, nearest);
  bool isSmall = cone.spread <= MAP_ALONE_SPREAD;
  if (!isSmall && !isHeld(layer, point, reach)) return MAP_UNSURE;
  for (int i = 0; i < MAP_ROUNDS && reach > ONE_BY_ONE_TEXELS; ++i) {
    float beyond;
    vec2 range = rangeWithin(point, reach, beyond);
    float rises = (abs(point.slope.x) + abs(point.slope.y)) * (reach + beyond); // the point's own plane, by as much
    if (range.y > point.depth + rises + point.bias) return 0.0;
    float narrower = reachAt(layer, point, cone, range.x);
    if (narrower > 0.95 * reach) break;
    reach = narrower;
  }
  if (reach <= ONE_BY_ONE_TEXELS) { // a penumbra of so few texels is finer than what the field could show
    float share = oneByOne(point, reach);
    if (share != MAP_UNSURE || !isSmall) return share != MAP_UNSURE ? share : filterPcf(point);
  }
  // Of perspective maps this leaks: near the light a disk of texels is narrow, and its middle far from the truth's.
  return isSmall || layer.depth.z > 0.5 ? filterByHeight(layer, point, cone, reach, isSmall) : MAP_UNSURE;
}

// The visible share of a light where its maps know it: 0 in umbrae, 1 where nothing is in the way, between for small
// lights, and for suns where what hides them is of one height; else MAP_UNSURE. Of a sun's cascades the finest that holds the whole cone answers.
//
// number  of the light
// cone    from the point to it
float shareByMaps(int number, ShadowCone cone, vec3 pointEye) {
  float cosine = dot(cone.normal, cone.axis);
  bool isSmall = cone.spread <= MAP_ALONE_SPREAD;
  if (cosine < (isSmall ? 0.0 : -cone.spread)) return 0.0;
  if (cosine < cone.spread && !isSmall) return MAP_UNSURE; // the surface itself cuts the light
  ShadowMapLight light = shadowMaps.lights[number];
  int layer = light.layers.y == 0 ? -1 : layerAt(light, pointEye);
  if (layer < 0) return isSmall ? 1.0 : MAP_UNSURE;
  float share = shareByLayer(light, mapPointIn(layer, pointEye, cone.normal), cone);
  if (light.layers.z != SHADOW_LAYOUT_CASCADES) return share;
  for (++layer; share == MAP_UNSURE && layer < light.layers.x + light.layers.y; ++layer)
    if (isInLayer(layer, pointEye)) share = shareByLayer(light, mapPointIn(layer, pointEye, cone.normal), cone);
  return share;
}
