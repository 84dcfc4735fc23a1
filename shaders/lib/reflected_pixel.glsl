// A pixel as its reflection sees it, and which of the pixels that are traced stand for one that is not: those on about
// the same plane, as smooth as it. The frame of both passes of reflections: first every scale-th pixel along both axes,
// then what lies between; a pixel like none of the four around it is traced itself.
#include "lib/gbuffer.glsl"
#include "lib/mirror_lobe.glsl"
#include "lib/visible_normals.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

uniform int scale;
uniform bool fillsGaps;

// Rougher ones mirror the surroundings alone; over a tenth before that the two blend.
const float MOST_ROUGHNESS = 0.7;
// As in lib/shadow_frame.glsl; and of bilinear weights what must be alike, lest one neighbour stands for all.
const float SAME_PLANE = 0.004, SAME_NORMAL = 0.96, SAME_ROUGHNESS = 0.1, LEAST_ALIKE = 0.4;

struct ReflectedPixel {
  bool isMirror;
  vec3 pointEye;
  vec3 normal;    // of the surface
  vec3 bent;      // as maps bend it
  vec3 toViewer;
  vec3 direction; // mirrored
  float roughness;
  float away; // from the eye, metres
};

// Bent normals may mirror what lies below the surface: then along it.
vec3 offSurface(vec3 direction, vec3 normal) {
  const float LEAST_RISING = 0.02;
  float rising = dot(direction, normal);
  return rising < LEAST_RISING ? normalize(direction + (LEAST_RISING - rising) * normal) : direction;
}

ReflectedPixel reflectedPixel(ivec2 pixel) {
  ReflectedPixel found;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  vec4 properties = texelFetch(material, pixel, 0), normals = texelFetch(normal_world_oct, pixel, 0);
  found.away = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
  found.pointEye = originEye + found.away * directionWorld;
  found.normal = directionFromOctahedral(normals.zw);
  found.bent = directionFromOctahedral(normals.xy);
  found.toViewer = -directionWorld;
  found.direction = offSurface(reflect(directionWorld, found.bent), found.normal);
  found.roughness = properties.g;
  found.isMirror = kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE && found.roughness < MOST_ROUGHNESS && properties.a < 0.5;
  return found;
}

// How far the mirrored direction turns from a pixel to those beside and above it, as a length: what a pixel mirrors is as
// wide, a metre away.
float turnOfPixel(ivec2 pixel, ReflectedPixel own) {
  float turn = 0.0;
  uint shown = texelFetch(id, pixel, 0).r;
  for (int i = 0; i < 2; ++i) {
    ivec2 beside = min(pixel + ivec2(1 - i, i), ivec2(frame.size.xy) - 1);
    if (texelFetch(id, beside, 0).r == shown) turn = max(turn, distance(reflectedPixel(beside).direction, own.direction));
  }
  return turn;
}

// The part of its lobe that a pixel traces.
struct LobePart {
  vec3 direction;
  float spread; // metres of width a metre of way
};

LobePart lobePart(ivec2 place, ReflectedPixel pixel) {
  const float GOLDEN = 0.61803399, LEAST_N_DOT_V = 1e-3; // bent normals may turn away from the viewer
  float whole = spreadOfRoughness(pixel.roughness), turn = turnOfPixel(place, pixel);
  float share = lobeShare(pixel.roughness, turn * float(scale));
  float spread = length(vec2(mix(whole, whole / float(2 * SHARERS), share), turn));
  if (share == 0.0) return LobePart(pixel.direction, spread);
  ivec2 cell = place / scale % SHARERS;
  int number = (cell.x + SHARERS * cell.y) * 7 % (SHARERS * SHARERS); // neighbours far apart
  vec2 square = vec2((float(number) + 0.5) / float(SHARERS * SHARERS), fract(float(number) * GOLDEN));
  vec3 aside = abs(pixel.bent.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), right = normalize(cross(pixel.bent, aside));
  mat3 worldFromLobe = mat3(right, cross(pixel.bent, right), pixel.bent);
  vec3 viewer = pixel.toViewer * worldFromLobe;
  viewer = normalize(vec3(viewer.xy, max(viewer.z, LEAST_N_DOT_V)));
  vec3 halfway = worldFromLobe * visibleNormal(share * pixel.roughness * pixel.roughness, viewer, square);
  return LobePart(offSurface(reflect(-pixel.toViewer, halfway), pixel.normal), spread);
}

bool isTracedPlace(ivec2 pixel) { return all(equal(pixel % scale, ivec2(0))); }

bool isAlike(ReflectedPixel pixel, ReflectedPixel other) {
  return other.isMirror && dot(pixel.normal, other.normal) >= SAME_NORMAL &&
         abs(dot(pixel.normal, other.pointEye - pixel.pointEye)) <= SAME_PLANE * pixel.away &&
         abs(pixel.roughness - other.roughness) <= SAME_ROUGHNESS;
}

// Weights of the four traced pixels around one; all 0 where it must be traced itself.
vec4 weightsAround(ivec2 pixel, ReflectedPixel own, out ivec2 places[4]) {
  ivec2 base = pixel / scale * scale, last = (ivec2(frame.size.xy) - 1) / scale * scale;
  vec2 part = vec2(pixel - base) / float(scale);
  vec4 weights;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    places[i] = min(base + corner * scale, last);
    vec2 near = mix(1.0 - part, part, vec2(corner));
    float weight = near.x * near.y;
    weights[i] = weight > 0.0 && isAlike(own, reflectedPixel(places[i])) ? weight : 0.0;
  }
  float sum = dot(weights, vec4(1.0));
  return sum < LEAST_ALIKE ? vec4(0.0) : weights / sum;
}
