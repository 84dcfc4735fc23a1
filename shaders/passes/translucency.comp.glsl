// Light that passes through SDF objects: Beer-Lambert over the way through their own bricks, from where each light comes
// in to the surface that is seen, and from behind along the normal for the light of the surroundings. And how thick they
// are along the view ray.
//
// Lambert's cosine on the back may be wrapped round to the front, where the light has scattered over short ways: the
// integral over all directions stays that of a diffuse surface.
#include "lib/brick_inside.glsl"
#include "lib/gbuffer.glsl"
#include "lib/light_arrival.glsl"
#include "lib/spherical_harmonics.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
layout(std430, binding = kSdfLookBinding) readonly buffer SdfLookBlock { SdfLook sdfLooks[]; };
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
#endif
layout(binding = 0, rgba16f) writeonly uniform image2D translucent; // rgb: radiance; a: share of the diffuse light
layout(binding = 1, r32f) writeonly uniform image2D thickness;      // metres

uniform float wrap;            // 0: Lambert's cosine
uniform bool isGiven;          // for all objects alike, in place of their materials' own
uniform vec4 givenTransmission; // rgb: absorption per metre; w: share

const float PI = 3.14159265;

struct InsidePoint {
  SdfInstance instance;
  SdfLevel level;
  vec3 pointGrid;
};

float waysInside(InsidePoint at, vec3 directionWorld) {
  return metresInside(at.instance, at.level, at.pointGrid, rowsTimesDirection(at.instance.gridFromWorld, directionWorld), frame.counts.z);
}

// Over all directions of an even light the sum is pi.
float wrappedCosine(float cosineBehind) { return max(cosineBehind + wrap, 0.0) / ((1.0 + wrap) * (1.0 + wrap)); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  uint packedId = texelFetch(id, pixel, 0).r;
  vec4 result = vec4(0.0);
  float metres = 0.0;
  if (kindOfId(packedId) == KIND_SDF) {
    InsidePoint at;
    at.instance = sdfInstances[numberOfId(packedId)];
    at.level = sdfLevels[at.instance.ids.y + int(levelOfBrick(texelFetch(trace, pixel, 0).g))];
    SdfLook look = sdfLooks[numberOfId(packedId)];
    vec3 absorption = isGiven ? givenTransmission.rgb : look.absorption.rgb, color = isGiven ? vec3(1.0) : look.transmission.rgb;
    // Metals are opaque.
    float share = (isGiven ? givenTransmission.w : look.transmission.w) * (1.0 - texelFetch(material, pixel, 0).r);

    vec3 originEye, directionWorld;
    viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
    vec3 pointEye = originEye + rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r) * directionWorld;
    at.pointGrid = gridFromEye(at.instance, pointEye);
    metres = waysInside(at, directionWorld);
    if (share > 0.0) {
      vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
      vec3 irradiance = evaluateHarmonics(frame.irradiance, -normal) * exp(-absorption * waysInside(at, -normal));
      for (int i = 0; i < int(frame.size.z); ++i) {
        vec3 toLight;
        vec3 arriving = lightAt(lights[i], frame.eyeWorld.xyz + pointEye, toLight);
        if (uint(lights[i].position.w) == LIGHT_RECTANGLE) arriving *= max(dot(lights[i].direction.xyz, -toLight), 0.0);
        float cosine = wrappedCosine(-dot(normal, toLight));
        if (cosine > 0.0) irradiance += arriving * cosine * exp(-absorption * waysInside(at, toLight));
      }
      result = vec4(min(share * color / PI * irradiance, vec3(65504.0)), share);
    }
  }
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_INSIDE_STEPS], insideSteps);
#endif
  imageStore(translucent, pixel, result);
  imageStore(thickness, pixel, vec4(metres));
}
