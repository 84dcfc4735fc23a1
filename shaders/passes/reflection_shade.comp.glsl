// How bright it is what the reflected rays of the listed pixels met: as the picture shows it where it does, else by the
// attributes of the object's own bricks, else by the look of its node; a cone that is partly free shows the surroundings
// through the rest.
#include "lib/reflected_pixel.glsl"
#include "lib/brick_attributes.glsl"
#include "lib/reflection_code.glsl"
#include "lib/sdf_space.glsl"
#include "lib/surface_light.glsl"
#include "shared/node_look_params.h"

layout(local_size_x = REFLECTION_GROUP) in;

layout(std430, binding = kNodeRowBinding) readonly buffer NodeRowBlock { uint nodeRows[]; };
layout(std430, binding = kNodeLookBinding) readonly buffer NodeLookBlock { NodeLook nodeLooks[]; };
layout(binding = kShadowUnit) uniform sampler2D shadow;
layout(binding = kOcclusionUnit) uniform sampler2D occlusion;
layout(binding = kReflectionHitUnit) uniform usampler2D reflection_hit;
layout(binding = 0, rgba16f) writeonly uniform image2D reflection;

uniform int shadowedLights; // the first ones
uniform bool isOccluded;

const int MOST_ROWS = 8; // instances of a node that are looked at
// What is mirrored in one point stands for all that a pixel mirrors: highlights as small as those of smoother surfaces
// would be met by a pixel here and there.
const float LEAST_MET_ROUGHNESS = 0.3;

// A small lamp that one ray of a rough cone meets does not fill it. What a ray may bring in, in whites of the picture,
// times the square of the cone's width: so much that a lamp in a mirror is as bright as it is, and on rough surfaces makes
// no sparks.
const float MOST_OF_CONE = 1.0;

struct MirroredSurface {
  Surface surface;
  vec3 pointEye;
  vec3 normal;
  vec3 emission;
  vec4 visible;
  float open;
  bool isUnlit;
};

// Where what a pixel mirrors covers many pixels of the picture, one of these would stand for all: by the eightfold width
// the node's mean colour takes its place.
//
// width  metres
float blurOfSeen(float width, float away) {
  float pixelMetres = 2.0 / (frame.projection.y * float(frame.size.y)) * (frame.projection.z > 0.5 ? 1.0 : away);
  return clamp(log2(max(width / pixelMetres, 1e-6)) / 3.0, 0.0, 1.0);
}

uint nodeSeen(ivec2 pixel) {
  uint packedId = texelFetch(id, pixel, 0).r, number = numberOfId(packedId);
  return kindOfId(packedId) == KIND_SDF ? uint(sdfInstances[number].ids.x) : number;
}

MirroredSurface surfaceSeen(ReflectionHit hit, float width) {
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(hit.pixel) + 0.5), originEye, directionWorld);
  vec4 properties = texelFetch(material, hit.pixel, 0);
  MirroredSurface found;
  found.surface = Surface(texelFetch(albedo, hit.pixel, 0).rgb, properties.r, properties.g, 0.0);
  float away = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, hit.pixel, 0).r);
  found.pointEye = originEye + away * directionWorld;
  found.surface.baseColor = mix(found.surface.baseColor, nodeLooks[nodeSeen(hit.pixel)].baseColor.rgb, blurOfSeen(width, away));
  found.normal = directionFromOctahedral(texelFetch(normal_world_oct, hit.pixel, 0).xy);
  found.emission = texelFetch(emission, hit.pixel, 0).rgb;
  found.visible = texelFetch(shadow, hit.pixel, 0);
  found.open = properties.b * (isOccluded ? texelFetch(occlusion, hit.pixel, 0).r : 1.0);
  found.isUnlit = properties.a > 0.5;
  return found;
}

// Attributes of an object's bricks at a point; false: it has none, or is elsewhere.
bool readNode(uint node, vec3 pointEye, out BrickAttributes found, out bool isUnlitThere) {
  isUnlitThere = false;
  uint rows = nodeRows[node - 1u], first = rows & 0xffffffu;
  if (rows == NO_BRICKS) return false;
  uint end = min(first + min(rows >> 24, uint(MOST_ROWS)), frame.counts.x); // behind the objects lie bricks for light
  for (uint row = first; row < end; ++row) {
    SdfInstance instance = sdfInstances[row];
    vec3 pointGrid = gridFromEye(instance, pointEye);
    if (any(lessThan(pointGrid, instance.boxMin.xyz - 2.0)) || any(greaterThan(pointGrid, instance.boxMax.xyz + 2.0))) continue;
    SdfLevel level = sdfLevels[instance.ids.y];
    if (!readAttributes(level, pointGrid * level.scale.x, found)) continue;
    isUnlitThere = isUnlit(level, pointGrid * level.scale.x, found);
    return true;
  }
  return false;
}

MirroredSurface surfaceOfNode(ReflectionHit hit, vec3 pointEye) {
  MirroredSurface found = MirroredSurface(Surface(vec3(0.5), 0.0, 1.0, 0.0), pointEye, hit.normal, vec3(0.0), hit.visible, 1.0, false);
  if (hit.node == 0u) return found;
  BrickAttributes attributes;
  if (readNode(hit.node, pointEye, attributes, found.isUnlit)) {
    found.surface = Surface(attributes.colorAndCoverage.rgb, attributes.material.r, attributes.material.g, 0.0);
    found.emission = attributes.emission;
    found.open = attributes.material.b;
  } else {
    NodeLook look = nodeLooks[hit.node - 1u];
    found.surface = Surface(look.baseColor.rgb, look.baseColor.w, look.emission.w, 0.0);
    found.emission = look.emission.rgb;
  }
  return found;
}

vec3 radianceOfMet(ivec2 place, ReflectedPixel pixel, vec3 direction, ReflectionHit hit) {
  MirroredSurface met = surfaceOfNode(hit, pixel.pointEye + hit.t * direction);
  if (hit.isSeen) met = surfaceSeen(hit, hit.t * turnOfPixel(place, pixel));
  if (met.isUnlit) return met.surface.baseColor;
  met.surface.roughness = max(met.surface.roughness, LEAST_MET_ROUGHNESS);
  vec3 toViewer = -direction;
  vec3 mirrored = environmentAround(reflect(direction, met.normal), met.surface.roughness);
  return met.emission + environmentLight(met.surface, met.normal, toViewer, met.open, met.open, mirrored) +
         directLight(met.surface, frame.eyeWorld.xyz + met.pointEye, met.normal, toViewer, met.visible, shadowedLights);
}

vec3 shadedReflection(ivec2 place, ReflectedPixel pixel, uvec4 code) {
  ReflectionHit hit = reflectionOfCode(code);
  LobePart part = lobePart(place, pixel);
  vec3 around = environmentAround(part.direction, min(roughnessOfSpread(part.spread), pixel.roughness));
  if (hit.free >= 1.0) return around;
  float rough = smoothstep(MOST_ROUGHNESS - 0.1, MOST_ROUGHNESS, pixel.roughness);
  vec3 met = radianceOfMet(place, pixel, part.direction, hit);
  float spread = spreadOfRoughness(pixel.roughness), most = MOST_OF_CONE / max(spread * spread * frame.projection.w, 1e-6);
  met *= min(most / max(max(met.r, met.g), max(met.b, 1e-6)), 1.0);
  return mix(met, around, max(hit.free, rough));
}

void main() {
  ivec2 pixel;
  if (!listedPixel(pixel)) return;
  vec3 radiance = shadedReflection(pixel, reflectedPixel(pixel), texelFetch(reflection_hit, pixel, 0));
  imageStore(reflection, pixel, vec4(min(radiance, vec3(65504.0)), 1.0));
}
