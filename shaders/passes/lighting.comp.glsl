// Deferred light of the whole frame: direct light, image-based light, emission, sky.
#include "lib/gbuffer.glsl"
#include "lib/reflected_pixel.glsl"
#include "lib/surface_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kShadowUnit) uniform sampler2D shadow;
layout(binding = kOcclusionUnit) uniform sampler2D occlusion;
layout(binding = kTranslucentUnit) uniform sampler2D translucent;
layout(binding = kReflectionUnit) uniform sampler2D reflection;
layout(binding = 0, rgba16f) writeonly uniform image2D color;

uniform int shadowedLights; // the first ones
uniform bool isOccluded, isTranslucent, isMirrored;

// Of the parts of its lobe that the pixels around have traced.
vec3 mirroredAround(ivec2 pixel) {
  const float SAME_BENT = 0.9;
  ReflectedPixel own = reflectedPixel(pixel);
  float share = own.isMirror ? sharedLobe(own, turnOfPixel(pixel, own)) : 0.0;
  if (share == 0.0) return texelFetch(reflection, pixel, 0).rgb;
  vec4 sum = vec4(0.0);
  const int REACH = SHARERS / 2;
  for (int y = -REACH; y <= REACH; ++y)
    for (int x = -REACH; x <= REACH; ++x) {
      ivec2 at = clamp(pixel + scale * ivec2(x, y), ivec2(0), ivec2(frame.size.xy) - 1);
      ReflectedPixel other = reflectedPixel(at);
      if (!isAlike(own, other) || dot(own.bent, other.bent) < SAME_BENT) continue;
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
    vec3 mirrored = isMirrored ? mirroredAround(pixel) : environmentAround(reflect(directionWorld, normal), surface.roughness);
    radiance = texelFetch(emission, pixel, 0).rgb + through.rgb +
               environmentLight(surface, normal, toViewer, properties.b * open, isMirrored ? properties.b : properties.b * open, mirrored) +
               directLight(surface, pointWorld, normal, toViewer, texelFetch(shadow, pixel, 0), shadowedLights);
  }
  imageStore(color, pixel, vec4(min(radiance, vec3(65504.0)), 1.0));
}
