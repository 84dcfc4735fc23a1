// What the reflected rays of the listed pixels meet, for reflection_shade.comp.glsl to say how bright it is.
#include "lib/reflected_pixel.glsl"
#include "lib/field_reflection.glsl"
#include "lib/light_arrival.glsl"
#include "lib/reflection_code.glsl"

layout(local_size_x = REFLECTION_GROUP) in;

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
#endif
layout(binding = 0, rgba32ui) writeonly uniform uimage2D reflection_hit;

uniform int shadowedLights; // the first ones

// Whether the picture shows a point of a surface, and where.
bool isSeen(vec3 pointEye, vec3 normal, float grain, out ivec2 pixel) {
  vec4 clip = frame.clipFromEye * vec4(pointEye, 1.0);
  pixel = ivec2(0);
  if (clip.w <= 0.0 || any(greaterThanEqual(abs(clip.xy), vec2(clip.w)))) return false;
  pixel = ivec2((clip.xy / clip.w * 0.5 + 0.5) * vec2(frame.size.xy));
  if (kindOfId(texelFetch(id, pixel, 0).r) == KIND_NONE) return false;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  float away = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
  const float SAME_SIDE = 0.3, SAME_PLACE_GRAINS = 2.0, SAME_PLACE = 0.01;
  vec3 shown = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
  return dot(shown, normal) > SAME_SIDE && distance(originEye + away * directionWorld, pointEye) < SAME_PLACE_GRAINS * grain + SAME_PLACE * away;
}

vec4 lightsSeen(vec3 pointAnchored, vec3 normal) {
  vec4 visible = vec4(1.0);
  for (int i = 0; i < shadowedLights; ++i) {
    vec3 toLight, pointWorld = pointAnchored - frame.eyeAnchored.xyz + frame.eyeWorld.xyz;
    lightAt(lights[i], pointWorld, toLight);
    bool isSun = uint(lights[i].position.w) == LIGHT_SUN;
    float before = isSun ? 0.0 : lights[i].intensity.w; // the light begins
    visible[i] = seesLight(pointAnchored, normal, toLight, isSun ? 3.4e38 : max(distance(lights[i].position.xyz, pointWorld) - before, 0.0));
  }
  return visible;
}

uvec4 tracedCode(ivec2 place, ReflectedPixel pixel) {
  vec3 origin = pixel.pointEye + frame.eyeAnchored.xyz;
  float grain = readForReflection(origin, 0.0).grain;
  LobePart part = lobePart(place, pixel);
  ReflectionMet met = traceReflection(ReflectionRay(origin, pixel.normal, part.direction, part.spread, grain));
  ReflectionHit hit = ReflectionHit(met.t, met.free, -part.direction, 0u, false, ivec2(0), vec4(1.0));
  if (met.free < 1.0) {
    hit.normal = normalOfMet(met, part.direction);
    vec3 surface = met.point - met.distanceWorld * hit.normal;
    hit.isSeen = isSeen(surface - frame.eyeAnchored.xyz, hit.normal, met.grain, hit.pixel);
    if (!hit.isSeen) {
      hit.node = nearestNode(surface);
      hit.visible = lightsSeen(surface, hit.normal);
    }
  }
  return codeOfReflection(hit);
}

void main() {
  ivec2 pixel;
  if (listedPixel(pixel)) imageStore(reflection_hit, pixel, tracedCode(pixel, reflectedPixel(pixel)));
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_REFLECTION_READS], reflectionReads);
#endif
}
