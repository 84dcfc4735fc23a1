// One layer of the frame as a picture; which one is a uniform.
#include "lib/debug_colors.glsl"
#include "lib/gbuffer.glsl"
#include "lib/tone_curve.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };
layout(binding = kOverdrawUnit) uniform sampler2D box_overdraw;
layout(binding = kShadowUnit) uniform sampler2D shadow;
layout(binding = kShadowReadsUnit) uniform usampler2D shadow_reads;
layout(binding = kOcclusionUnit) uniform sampler2D occlusion;
layout(binding = kThicknessUnit) uniform sampler2D thickness;
layout(binding = kReflectionUnit) uniform sampler2D reflection;
layout(binding = 0, rgba8) writeonly uniform image2D picture;

uint nodeOfId(uint packedId) {
  uint number = numberOfId(packedId);
  return kindOfId(packedId) == KIND_SDF ? uint(sdfInstances[number].ids.x) : number;
}

float viewUnit(float value) { return (value - frame.debugRange.x) / max(frame.debugRange.y - frame.debugRange.x, 1e-6); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  uint packedId = texelFetch(id, pixel, 0).r;
  uint kind = kindOfId(packedId);
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
  uvec2 traced = texelFetch(trace, pixel, 0).rg;

  vec3 shown = vec3(0.0);
  switch (frame.size.w) {
    case DEBUG_VIEW_DEPTH: shown = kind == KIND_NONE ? vec3(0.0) : vec3(1.0 - clamp(viewUnit(t), 0.0, 0.95)); break;
    case DEBUG_VIEW_NORMAL: shown = kind == KIND_NONE ? vec3(0.0) : directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).xy) * 0.5 + 0.5; break;
    case DEBUG_VIEW_ALBEDO: shown = srgbFromLinear(texelFetch(albedo, pixel, 0).rgb) * float(kind != KIND_NONE); break;
    case DEBUG_VIEW_ID: shown = kind == KIND_NONE ? vec3(0.0) : idColor(nodeOfId(packedId)); break;
    case DEBUG_VIEW_KIND: shown = kind == KIND_NONE ? vec3(0.08) : kind == KIND_MESH ? vec3(0.25, 0.5, 0.9) : vec3(0.95, 0.6, 0.2); break;
    case DEBUG_VIEW_STEPS: shown = kind == KIND_SDF ? heat(viewUnit(float(traced.x))) : vec3(0.08); break;
    case DEBUG_VIEW_BRICKS: {
      // A colour for each brick in which a ray ended, lit from the eye so that shapes stay readable.
      float facing = abs(dot(directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).xy), directionWorld));
      shown = kind == KIND_SDF ? idColor(traced.y) * (0.4 + 0.6 * facing) : vec3(0.08);
      break;
    }
    case DEBUG_VIEW_OVERDRAW: shown = heat(viewUnit(texelFetch(box_overdraw, pixel, 0).r)); break;
    case DEBUG_VIEW_SHADOW: {
      vec4 visible = texelFetch(shadow, pixel, 0);
      if (kind != KIND_NONE) shown = frame.size.z == 1u ? visible.rrr : visible.rgb;
      break;
    }
    case DEBUG_VIEW_SHADOW_READS: shown = heat(viewUnit(float(texelFetch(shadow_reads, pixel, 0).r))); break;
    case DEBUG_VIEW_AO: shown = vec3(texelFetch(occlusion, pixel, 0).r); break;
    case DEBUG_VIEW_THICKNESS: shown = kind == KIND_SDF ? heat(viewUnit(texelFetch(thickness, pixel, 0).r)) : vec3(0.08); break;
    case DEBUG_VIEW_REFLECTION: shown = kind == KIND_NONE ? vec3(0.0) : srgbFromLinear(filmicCurve(texelFetch(reflection, pixel, 0).rgb * frame.projection.w)); break;
    default: break;
  }
  imageStore(picture, pixel, vec4(shown, 1.0));
}
