// Deferred light of the whole frame: direct light, image-based light, emission, sky.
#include "lib/gbuffer.glsl"
#include "lib/mirror_lobe.glsl"
#include "lib/surface_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kShadowUnit) uniform sampler2D shadow;
layout(binding = kOcclusionUnit) uniform sampler2D occlusion;
layout(binding = kTranslucentUnit) uniform sampler2D translucent;
layout(binding = kReflectionUnit) uniform sampler2D reflection;
layout(binding = 0, rgba16f) writeonly uniform image2D color;

uniform int shadowedLights; // the first ones
uniform bool isOccluded, isTranslucent, isMirrored;
uniform int mirrorScale; // every so many pixels is traced, along both axes

// Of the parts of its lobe that the pixels around have traced.
vec3 mirroredAround(ivec2 pixel, vec3 normal, vec3 mirrored, float roughness) {
  const float SAME_NORMAL = 0.9;
  uint shown = texelFetch(id, pixel, 0).r;
  float turn = 0.0;
  for (int i = 0; i < 2; ++i) {
    ivec2 beside = min(pixel + ivec2(1 - i, i), ivec2(frame.size.xy) - 1);
    if (texelFetch(id, beside, 0).r != shown) continue;
    vec3 originEye, directionWorld;
    viewRay(ndcFromPixel(vec2(beside) + 0.5), originEye, directionWorld);
    turn = max(turn, distance(reflect(directionWorld, directionFromOctahedral(texelFetch(normal_world_oct, beside, 0).xy)), mirrored));
  }
  float share = lobeShare(roughness, turn * float(mirrorScale));
  if (share == 0.0) return texelFetch(reflection, pixel, 0).rgb;
  vec4 sum = vec4(0.0);
  const int REACH = SHARERS / 2;
  for (int y = -REACH; y <= REACH; ++y)
    for (int x = -REACH; x <= REACH; ++x) {
      ivec2 at = clamp(pixel + mirrorScale * ivec2(x, y), ivec2(0), ivec2(frame.size.xy) - 1);
      if (texelFetch(id, at, 0).r != shown) continue;
      if (dot(directionFromOctahedral(texelFetch(normal_world_oct, at, 0).xy), normal) < SAME_NORMAL) continue;
      sum += sharedWeight(ivec2(x, y), share) * vec4(texelFetch(reflection, at, 0).rgb, 1.0);
    }
  return sum.rgb / sum.a; // the pixel itself is in it
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  if (kindOfId(texelFetch(id, pixel, 0).r) == KIND_NONE) {
    imageStore(color, pixel, vec4(environmentAround(directionWorld, 0.0), 1.0));
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
    float open = isOccluded ? texelFetch(occlusion, pixel, 0).r : 1.0;
    // What is mirrored was traced where it is: what stands around is in it.
    vec3 mirrored = reflect(directionWorld, normal);
    mirrored = isMirrored ? mirroredAround(pixel, normal, mirrored, surface.roughness) : environmentAround(mirrored, surface.roughness);
    radiance = texelFetch(emission, pixel, 0).rgb + through.rgb +
               environmentLight(surface, normal, toViewer, properties.b * open, isMirrored ? properties.b : properties.b * open, mirrored) +
               directLight(surface, pointWorld, normal, toViewer, texelFetch(shadow, pixel, 0), shadowedLights);
  }
  imageStore(color, pixel, vec4(min(radiance, vec3(65504.0)), 1.0));
}
