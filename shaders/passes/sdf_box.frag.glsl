// Traces one SDF object through one pixel and writes the G-buffer. Conservative depth: a hit lies behind the box face,
// and with reverse Z behind means smaller; the value is clamped to the face's own, so the promise holds to the last bit.
// DEPTH_ONLY: into a shadow map; the frame's parameters are then those of the light's view.
#include "lib/frame.glsl"
#include "lib/octahedral.glsl"
#include "lib/packing.glsl"
#include "lib/sdf_hit.glsl"

layout(depth_less) out float gl_FragDepth;

#ifndef DEPTH_ONLY
layout(binding = kDepthMeshUnit) uniform sampler2D depth_mesh;
#endif
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[COUNTERS]; };
#endif

layout(location = 0) flat in uint entry;

#ifndef DEPTH_ONLY
layout(location = 0) out vec4 normal_world_oct; // xy: shading normal; zw: surface normal, the same here
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 material;         // metallic, roughness, occlusion, unlit
layout(location = 3) out vec3 emission;
layout(location = 4) out uint id;
layout(location = 5) out uvec2 trace;
#endif

void main() {
  SdfInstance instance = sdfInstances[entry & VISIBLE_INDEX_MASK];
  SdfLevel level = levelOfEntry(instance, entry);
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(gl_FragCoord.xy), originEye, directionWorld);
  float tMost = 3.4e38;
#ifndef DEPTH_ONLY
  // A mesh in front ends the ray; the slack leaves near ties to the depth test.
  tMost = 1.0001 * rayParameterOfDepth(originEye, directionWorld, texelFetch(depth_mesh, ivec2(gl_FragCoord.xy), 0).r);
#endif
  BrickAttributes attributes;
  SdfHit hit = traceObject(instance, level, originEye, directionWorld, tMost, attributes);
#if defined(COUNTERS_ON) && defined(DEPTH_ONLY)
  atomicAdd(counters[COUNTER_MAP_FRAGMENTS], 1u);
  atomicAdd(counters[COUNTER_MAP_STEPS], hit.steps);
#elif defined(COUNTERS_ON)
  atomicAdd(counters[COUNTER_FRAGMENTS], 1u);
  atomicAdd(counters[COUNTER_STEPS], hit.steps);
  atomicAdd(counters[COUNTER_BRICK_READS], hit.brickReads);
  if (hit.hit) atomicAdd(counters[COUNTER_HITS], 1u);
  if (hit.steps >= frame.counts.z) atomicAdd(counters[COUNTER_OUT_OF_STEPS], 1u);
#endif
  if (!hit.hit) discard;

  vec3 pointEye = originEye + hit.t * directionWorld;
  float depth = depthOfPoint(pointEye);
  gl_FragDepth = min(depth, gl_FragCoord.z);
#ifdef COUNTERS_ON
  // Rounding of the two ways to the same depth stays within a few units of the last place; more is a broken promise.
  if (depth > gl_FragCoord.z * (1.0 + 1e-4)) atomicAdd(counters[COUNTER_PROMISE_BROKEN], 1u);
#endif

#ifndef DEPTH_ONLY
  vec2 normalOct = octahedralFromDirection(normalOfHit(instance, level, hit.pointLevel, hit.backFace, directionWorld));
  normal_world_oct = vec4(normalOct, normalOct);
  albedo = vec4(attributes.colorAndCoverage.rgb, 1.0);
  material = vec4(attributes.material.rgb, isUnlit(level, hit.pointLevel, attributes));
  emission = attributes.emission;
  id = packId(entry & VISIBLE_INDEX_MASK, KIND_SDF);
  trace = traceOfHit(level, hit.pointLevel, hit.steps, entry);
#endif
}
