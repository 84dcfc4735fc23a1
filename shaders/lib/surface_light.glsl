// What a surface sends back of lights and surroundings; for the pixels of the picture and for what they mirror.
#include "lib/brdf.glsl"
#include "lib/environment.glsl"
#include "lib/frame.glsl"
#include "lib/light_arrival.glsl"
#include "lib/spherical_harmonics.glsl"

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
layout(binding = kEnvironmentUnit) uniform sampler2D environment_prefiltered;
layout(binding = kEnvironmentBrdfUnit) uniform sampler2D environment_brdf;

uniform bool isBlinnPhong; // of direct light; the surroundings are always those of Cook-Torrance

// Radiance of the surroundings as a lobe of a roughness sees it.
vec3 environmentAround(vec3 direction, float roughness) {
  return textureLod(environment_prefiltered, equirectFromDirection(direction), roughness * float(frame.counts.w - 1u)).rgb;
}

vec3 directShare(Surface surface, vec3 normal, vec3 toViewer, vec3 toLight) {
  return isBlinnPhong ? blinnPhongShare(surface, normal, toViewer, toLight) : reflectedShare(surface, normal, toViewer, toLight);
}

// From a panel of one radiance on its front: as from 16 points of it.
vec3 rectangleLight(LightRow light, Surface surface, vec3 pointWorld, vec3 normal, vec3 toViewer) {
  const int SIDE = 4;
  vec3 up = normalize(cross(light.cone.xyz, light.direction.xyz)) * light.cone.w, sum = vec3(0.0);
  for (int i = 0; i < SIDE * SIDE; ++i) {
    vec2 place = (vec2(i % SIDE, i / SIDE) + 0.5) * (2.0 / float(SIDE)) - 1.0;
    vec3 offset = light.position.xyz + place.x * light.cone.xyz + place.y * up - pointWorld;
    float distance2 = max(dot(offset, offset), 1e-8);
    vec3 toLight = offset * inversesqrt(distance2);
    float facing = max(dot(light.direction.xyz, -toLight), 0.0);
    sum += facing / distance2 * directShare(surface, normal, toViewer, toLight);
  }
  return light.intensity.rgb * sum / float(SIDE * SIDE);
}

// Of even surroundings of radiance 1 what smooth reflection sends back (Karis 2013).
vec3 specularShareOf(Surface surface, vec3 normal, vec3 toViewer) {
  float nDotV = clamp(dot(normal, toViewer), 0.0, 1.0);
  vec2 scaleBias = textureLod(environment_brdf, vec2(nDotV, surface.roughness), 0.0).rg;
  return mix(vec3(0.04), surface.baseColor, surface.metallic) * scaleBias.x + scaleBias.y;
}

// mirrored  radiance that comes from where the surface mirrors the viewer
vec3 environmentLight(Surface surface, vec3 normal, vec3 toViewer, float openDiffuse, float openSpecular, vec3 mirrored) {
  vec3 specularShare = specularShareOf(surface, normal, toViewer);
  vec3 diffuse = evaluateHarmonics(frame.irradiance, normal) / kPi * diffuseColor(surface);
  return openDiffuse * (1.0 - specularShare) * diffuse + openSpecular * specularShare * mirrored;
}

// visible  shares of the first `shadowed` lights
vec3 directLight(Surface surface, vec3 pointWorld, vec3 normal, vec3 toViewer, vec4 visible, int shadowed) {
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < int(frame.size.z); ++i) {
    float share = i < shadowed ? visible[i] : 1.0;
    if (uint(lights[i].position.w) == LIGHT_RECTANGLE) {
      radiance += share * rectangleLight(lights[i], surface, pointWorld, normal, toViewer);
      continue;
    }
    vec3 toLight;
    vec3 irradiance = share * lightAt(lights[i], pointWorld, toLight);
    radiance += irradiance * directShare(surface, normal, toViewer, toLight);
  }
  return radiance;
}
