// Deferred light of the whole frame: direct light, image-based light, emission, sky.
#include "lib/brdf.glsl"
#include "lib/environment.glsl"
#include "lib/gbuffer.glsl"
#include "lib/light_arrival.glsl"
#include "lib/spherical_harmonics.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kLightBinding) readonly buffer LightBlock { LightRow lights[]; };
layout(binding = kEnvironmentUnit) uniform sampler2D environment_prefiltered;
layout(binding = kEnvironmentBrdfUnit) uniform sampler2D environment_brdf;
layout(binding = kShadowUnit) uniform sampler2D shadow;
layout(binding = kOcclusionUnit) uniform sampler2D occlusion;
layout(binding = kTranslucentUnit) uniform sampler2D translucent;
layout(binding = 0, rgba16f) writeonly uniform image2D color;

uniform int shadowedLights; // the first ones
uniform bool isOccluded, isTranslucent;
uniform bool isBlinnPhong; // of direct light; the surroundings are always those of Cook-Torrance

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

vec3 environmentLight(Surface surface, vec3 normal, vec3 toViewer, float occlusion) {
  float nDotV = clamp(dot(normal, toViewer), 0.0, 1.0);
  vec3 f0 = mix(vec3(0.04), surface.baseColor, surface.metallic);
  vec2 scaleBias = textureLod(environment_brdf, vec2(nDotV, surface.roughness), 0.0).rg;
  vec3 specularShare = f0 * scaleBias.x + scaleBias.y;
  float mip = surface.roughness * float(frame.counts.w - 1u);
  vec3 specular = textureLod(environment_prefiltered, equirectFromDirection(reflect(-toViewer, normal)), mip).rgb;
  vec3 diffuse = evaluateHarmonics(frame.irradiance, normal) / kPi * diffuseColor(surface);
  return occlusion * ((1.0 - specularShare) * diffuse + specularShare * specular);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  if (kindOfId(texelFetch(id, pixel, 0).r) == KIND_NONE) {
    imageStore(color, pixel, vec4(textureLod(environment_prefiltered, equirectFromDirection(directionWorld), 0.0).rgb, 1.0));
    return;
  }
  vec4 properties = texelFetch(material, pixel, 0);
  vec4 through = isTranslucent ? texelFetch(translucent, pixel, 0) : vec4(0.0);
  Surface surface = Surface(texelFetch(albedo, pixel, 0).rgb, properties.r, properties.g, through.a);
  vec3 radiance;
  if (properties.a > 0.5) {
    radiance = surface.baseColor;
  } else {
    float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
    vec3 pointWorld = frame.eyeWorld.xyz + (originEye + t * directionWorld);
    vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).xy);
    vec3 toViewer = -directionWorld;
    float open = properties.b * (isOccluded ? texelFetch(occlusion, pixel, 0).r : 1.0);
    radiance = texelFetch(emission, pixel, 0).rgb + through.rgb + environmentLight(surface, normal, toViewer, open);
    vec4 visible = texelFetch(shadow, pixel, 0);
    for (int i = 0; i < int(frame.size.z); ++i) {
      float share = i < shadowedLights ? visible[i] : 1.0;
      if (uint(lights[i].position.w) == LIGHT_RECTANGLE) {
        radiance += share * rectangleLight(lights[i], surface, pointWorld, normal, toViewer);
        continue;
      }
      vec3 toLight;
      vec3 irradiance = share * lightAt(lights[i], pointWorld, toLight);
      radiance += irradiance * directShare(surface, normal, toViewer, toLight);
    }
  }
  imageStore(color, pixel, vec4(min(radiance, vec3(65504.0)), 1.0));
}
