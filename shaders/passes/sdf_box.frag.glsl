// Traces one SDF object through one pixel and writes the G-buffer. Conservative depth: a hit lies behind the box face,
// and with reverse Z behind means smaller; the value is clamped to the face's own, so the promise holds to the last bit.
// DEPTH_ONLY: into a shadow map; the frame's parameters are then those of the light's view.
#include "lib/brick_attributes.glsl"
#include "lib/brick_trace.glsl"
#include "lib/frame.glsl"
#include "lib/motion.glsl"
#include "lib/octahedral.glsl"
#include "lib/packing.glsl"
#include "lib/sdf_space.glsl"

layout(depth_less) out float gl_FragDepth;

#ifndef DEPTH_ONLY
layout(binding = kDepthMeshUnit) uniform sampler2D depth_mesh;
#endif
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[COUNTERS]; };
#endif

layout(location = 0) flat in uint entry;

#ifdef DEPTH_ONLY
vec4 albedo, material; // of which only the coverage counts
vec3 emission;
#else
layout(location = 0) out vec4 normal_world_oct; // xy: shading normal; zw: surface normal, the same here
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 material;         // metallic, roughness, occlusion, unlit
layout(location = 3) out vec3 emission;
layout(location = 4) out uint id;
layout(location = 5) out uvec2 trace;
#endif
#ifdef MOTION_ON
layout(std430, binding = kPassBufferBBinding) readonly buffer MotionBlock { SdfMotion sdfMotions[]; };
layout(location = 6) out vec4 motion;
#endif

// Layers of cut surface that a ray passes; a crown of leaf cards has fewer in one line.
const int kMostCuts = 16;
// Beyond the hit, far enough that its own rounding is not met again.
const float kPastCutVoxels = 1e-2;

// Writes the attributes of the surface at a point. Returns its coverage: below a half the surface is cut away there.
float writeSurface(SdfLevel level, vec3 pointLevel) {
  BrickAttributes found;
  readAttributes(level, pointLevel, found);
  albedo = vec4(found.colorAndCoverage.rgb, 1.0);
  material = found.material;
  emission = found.emission;
  return found.colorAndCoverage.a;
}

void main() {
  SdfInstance instance = sdfInstances[entry & VISIBLE_INDEX_MASK];
  SdfLevel level = sdfLevels[instance.ids.y + int((entry >> VISIBLE_LEVEL_SHIFT) & VISIBLE_LEVEL_MASK)];

  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(gl_FragCoord.xy), originEye, directionWorld);
  vec3 originGrid = gridFromEye(instance, originEye);
  vec3 directionGrid = rowsTimesDirection(instance.gridFromWorld, directionWorld);
  vec2 range = boxRange(instance, originGrid, directionGrid, rayParameterOfNear(directionWorld));
#ifndef DEPTH_ONLY
  // A mesh in front ends the ray; the slack leaves near ties to the depth test.
  float tMesh = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth_mesh, ivec2(gl_FragCoord.xy), 0).r);
  range.y = min(range.y, tMesh * 1.0001);
#endif

  TraceHit hit = TraceHit(false, false, 0.0, 0u, 0u);
  vec3 pointLevel = vec3(0.0);
  // The trace runs relative to its entry: t from far away would spend float digits on the way to the box.
  vec3 entryGrid = originGrid + range.x * directionGrid;
  if (range.x <= range.y) {
    bool doubleSided = (instance.ids.w & int(SDF_DOUBLE_SIDED)) != 0;
    vec2 remaining = vec2(0.0, range.y - range.x);
    // Where the surface is cut away (masks, backs of single-sided sheets) the ray goes on behind the hit.
    for (int cut = 0; cut < kMostCuts; ++cut) {
      TraceHit next = traceBricks(level, entryGrid, directionGrid, remaining, doubleSided, frame.counts.z - hit.steps);
      hit = TraceHit(next.hit, next.backFace, next.t, hit.steps + next.steps, hit.brickReads + next.brickReads);
      if (!hit.hit) break;
      pointLevel = (entryGrid + hit.t * directionGrid) * level.scale.x;
      if (writeSurface(level, pointLevel) >= 0.5) break;
      hit.hit = false;
      remaining.x = hit.t + kPastCutVoxels / (length(directionGrid) * level.scale.x);
    }
  }
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

  float t = range.x + hit.t;
  float depth = depthOfPoint(originEye + t * directionWorld);
  gl_FragDepth = min(depth, gl_FragCoord.z);
#ifdef COUNTERS_ON
  // Rounding of the two ways to the same depth stays within a few units of the last place; more is a broken promise.
  if (depth > gl_FragCoord.z * (1.0 + 1e-4)) atomicAdd(counters[COUNTER_PROMISE_BROKEN], 1u);
#endif

#ifndef DEPTH_ONLY
  vec3 gradientLevel = fieldGradient(level, pointLevel, kNormalRadiusVoxels);
  // Normals are carried by the transpose of gridFromWorld; this holds for shears and mirrors too.
  vec3 normalWorld = gradientLevel.x * instance.gridFromWorld[0].xyz + gradientLevel.y * instance.gridFromWorld[1].xyz +
                     gradientLevel.z * instance.gridFromWorld[2].xyz;
  normalWorld = hit.backFace ? -normalWorld : normalWorld;
  normalWorld = dot(normalWorld, normalWorld) > 0.0 ? normalize(normalWorld) : -directionWorld;
  vec2 normalOct = octahedralFromDirection(normalWorld);
  normal_world_oct = vec4(normalOct, normalOct);

  id = packId(entry & VISIBLE_INDEX_MASK, KIND_SDF);
  ivec3 brick = brickOfPoint(level, pointLevel);
  uint brickNumber = (uint(brick.z) * level.cells.z + uint(brick.y)) * level.cells.y + uint(brick.x);
  trace = uvec2(hit.steps, packBrick(brickNumber + 1u, (entry >> VISIBLE_LEVEL_SHIFT) & VISIBLE_LEVEL_MASK));
#endif
#ifdef MOTION_ON
  SdfMotion then = sdfMotions[entry & VISIBLE_INDEX_MASK];
  vec3 originThen = vec3(then.previousWorldFromGrid[0].w, then.previousWorldFromGrid[1].w, then.previousWorldFromGrid[2].w);
  vec3 pointThen = rowsTimesDirection(then.previousWorldFromGrid, pointLevel / level.scale.x);
  motion = vec4(motionOf(originEye + t * directionWorld, pointThen + (originThen - frame.eyeWorld.xyz)), 0.0);
#endif
}
