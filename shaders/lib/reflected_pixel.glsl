// A pixel as its reflection sees it, and the part of its lobe that it traces. Traced are every scale-th pixel along both
// axes, and those between that are like none of the four around them.
#include "lib/gbuffer.glsl"
#include "lib/mirror_lobe.glsl"
#include "lib/visible_normals.glsl"
#include "shared/sdf_params.h"

uniform int scale; // every so many pixels is traced, along both axes

// Rougher ones mirror the surroundings alone; over a tenth before that the two blend.
const float MOST_ROUGHNESS = 0.7;

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

// Whether two pixels are of one plane, as smooth as each other.
bool isAlike(ReflectedPixel pixel, ReflectedPixel other) {
  const float SAME_PLANE = 0.004, SAME_NORMAL = 0.96, SAME_ROUGHNESS = 0.1; // the first two as in lib/shadowed_pixel.glsl
  return other.isMirror && dot(pixel.normal, other.normal) >= SAME_NORMAL &&
         abs(dot(pixel.normal, other.pointEye - pixel.pointEye)) <= SAME_PLANE * pixel.away &&
         abs(pixel.roughness - other.roughness) <= SAME_ROUGHNESS;
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

float sharedLobe(ReflectedPixel pixel, float turn) { return lobeShare(pixel.roughness, turn * float(scale)); }

LobePart lobePart(ivec2 place, ReflectedPixel pixel) {
  const float GOLDEN = 0.61803399, LEAST_N_DOT_V = 1e-3; // bent normals may turn away from the viewer
  float whole = spreadOfRoughness(pixel.roughness), turn = turnOfPixel(place, pixel);
  float share = sharedLobe(pixel, turn);
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
