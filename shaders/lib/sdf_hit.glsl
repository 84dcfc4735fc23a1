// What a pixel's ray meets of one SDF object, whoever asks: a fragment of its box, or a thread of a tile.
#include "lib/brick_trace.glsl"
#include "lib/card_crossing.glsl"
#include "lib/sdf_space.glsl"

// Layers of cut surface that a ray passes; a crown of leaf cards has fewer in one line.
const int kMostCuts = 16;
// Beyond the hit, far enough that its own rounding is not met again.
const float kPastCutVoxels = 1e-2;

struct SdfHit {
  bool hit;
  bool backFace;
  float t; // of the view ray, metres
  vec3 pointLevel;
  uint steps;
  uint brickReads;
};

SdfLevel levelOfEntry(SdfInstance instance, uint entry) {
  return sdfLevels[instance.ids.y + int((entry >> VISIBLE_LEVEL_SHIFT) & VISIBLE_LEVEL_MASK)];
}

// tMost       the ray ends there
// attributes  of the surface that was hit
SdfHit traceObject(SdfInstance instance, SdfLevel level, vec3 originEye, vec3 directionWorld, float tMost, out BrickAttributes attributes) {
  vec3 originGrid = gridFromEye(instance, originEye);
  vec3 directionGrid = rowsTimesDirection(instance.gridFromWorld, directionWorld);
  vec2 range = boxRange(instance, originGrid, directionGrid, rayParameterOfNear(directionWorld));
  range.y = min(range.y, tMost);
  SdfHit found = SdfHit(false, false, 0.0, vec3(0.0), 0u, 0u);
  if (range.x > range.y) return found;
  // The trace runs relative to its entry: t from far away would spend float digits on the way to the box.
  vec3 entryGrid = originGrid + range.x * directionGrid;
  bool doubleSided = (instance.ids.w & int(SDF_DOUBLE_SIDED)) != 0;
  vec2 remaining = vec2(0.0, range.y - range.x);
  vec3 directionUnit = normalize(directionGrid);
  // Where the surface is cut away (masks, backs of single-sided sheets), or is the slab of a card that the ray does not
  // cross, the ray goes on behind the hit.
  for (int cut = 0; cut < kMostCuts; ++cut) {
    TraceHit next = traceBricks(level, entryGrid, directionGrid, remaining, doubleSided, frame.counts.z - found.steps);
    found.steps += next.steps;
    found.brickReads += next.brickReads;
    if (!next.hit) break;
    found.pointLevel = (entryGrid + next.t * directionGrid) * level.scale.x;
    readAttributes(level, found.pointLevel, attributes);
    if (isCovered(level, found.pointLevel, directionUnit, next.backFace, attributes)) {
      found.hit = true;
      found.backFace = next.backFace;
      found.t = range.x + next.t;
      break;
    }
    remaining.x = next.t + kPastCutVoxels / (length(directionGrid) * level.scale.x);
  }
  return found;
}

// Of the world, unit, towards the eye's side.
vec3 normalOfHit(SdfInstance instance, SdfLevel level, vec3 pointLevel, bool backFace, vec3 directionWorld) {
  vec3 gradientLevel = fieldGradient(level, pointLevel, kNormalRadiusVoxels);
  // Normals are carried by the transpose of gridFromWorld; this holds for shears and mirrors too.
  vec3 normalWorld = gradientLevel.x * instance.gridFromWorld[0].xyz + gradientLevel.y * instance.gridFromWorld[1].xyz +
                     gradientLevel.z * instance.gridFromWorld[2].xyz;
  normalWorld = backFace ? -normalWorld : normalWorld;
  return dot(normalWorld, normalWorld) > 0.0 ? normalize(normalWorld) : -directionWorld;
}

// For the trace layer: steps, and where the ray ended.
uvec2 traceOfHit(SdfLevel level, vec3 pointLevel, uint steps, uint entry) {
  ivec3 brick = brickOfPoint(level, pointLevel);
  uint brickNumber = (uint(brick.z) * level.cells.z + uint(brick.y)) * level.cells.y + uint(brick.x);
  return uvec2(steps, packBrick(brickNumber + 1u, (entry >> VISIBLE_LEVEL_SHIFT) & VISIBLE_LEVEL_MASK));
}
