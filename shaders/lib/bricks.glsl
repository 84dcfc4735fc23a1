// Reads of the brick pools: indirection cells, stored distances, attributes. Includers get the bindings with it.
// Spaces: grid = voxels of the finest level; level = voxels of one level; brick = samples inside one brick (0 to 7).
#include "shared/bindings.h"
#include "shared/sdf_params.h"

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };
layout(std430, binding = kSdfLevelBinding) readonly buffer SdfLevelBlock { SdfLevel sdfLevels[]; };
layout(std430, binding = kIndirectionBinding) readonly buffer IndirectionBlock { uint indirection[]; };

layout(binding = kDistanceR8Unit) uniform sampler3D distance_r8;
layout(binding = kDistanceR16Unit) uniform sampler3D distance_r16;
layout(binding = kBrickBaseColorUnit) uniform sampler3D brick_base_color;
layout(binding = kBrickMaterialUnit) uniform sampler3D brick_material;
layout(binding = kBrickEmissionUnit) uniform sampler3D brick_emission;

ivec3 brickOfPoint(SdfLevel level, vec3 pointLevel) {
  return clamp(ivec3(floor(pointLevel / float(BRICK_CELLS))), ivec3(0), ivec3(level.cells.yzw) - 1);
}

uint cellOfBrick(uint firstCell, SdfLevel level, ivec3 brick) {
  return indirection[firstCell + (uint(brick.z) * level.cells.z + uint(brick.y)) * level.cells.y + uint(brick.x)];
}

// First texel of a slot. Slots fill a layer of the pool texture, x fastest.
ivec3 texelOfSlot(uint slot) {
  const uint mask = BRICK_POOL_SIDE - 1u;
  uvec3 at = uvec3(slot & mask, slot / BRICK_POOL_SIDE & mask, slot / (BRICK_POOL_SIDE * BRICK_POOL_SIDE));
  return ivec3(at * BRICK_SAMPLES);
}

bool isR16(SdfLevel level) { return level.scale.z > 0.5; }

// Signed bound of an empty cell in level voxels.
float boundOfCell(uint cell) {
  float bound = float(cell & CELL_BOUND_MASK) / 16.0;
  return (cell & CELL_INSIDE) != 0u ? -bound : bound;
}

// Filtered distance in level voxels inside a brick; pointBrick in [0,7].
float brickDistance(SdfLevel level, uint slot, vec3 pointBrick) {
  vec3 uvw = (vec3(texelOfSlot(slot)) + pointBrick + 0.5) * vec3(vec2(BRICK_POOL_TEXEL), level.scale.w);
  return (isR16(level) ? textureLod(distance_r16, uvw, 0.0).r : textureLod(distance_r8, uvw, 0.0).r) * level.scale.y;
}

// The eight stored distances around a voxel: x fastest, a = z 0, b = z 1.
void voxelCorners(SdfLevel level, uint slot, ivec3 voxelBrick, out vec4 a, out vec4 b) {
  if (isR16(level)) {
    ivec3 t = texelOfSlot(slot) + voxelBrick;
    a = vec4(texelFetch(distance_r16, t, 0).r, texelFetch(distance_r16, t + ivec3(1, 0, 0), 0).r,
             texelFetch(distance_r16, t + ivec3(0, 1, 0), 0).r, texelFetch(distance_r16, t + ivec3(1, 1, 0), 0).r);
    b = vec4(texelFetch(distance_r16, t + ivec3(0, 0, 1), 0).r, texelFetch(distance_r16, t + ivec3(1, 0, 1), 0).r,
             texelFetch(distance_r16, t + ivec3(0, 1, 1), 0).r, texelFetch(distance_r16, t + ivec3(1, 1, 1), 0).r);
  } else {
    ivec3 t = texelOfSlot(slot) + voxelBrick;
    a = vec4(texelFetch(distance_r8, t, 0).r, texelFetch(distance_r8, t + ivec3(1, 0, 0), 0).r,
             texelFetch(distance_r8, t + ivec3(0, 1, 0), 0).r, texelFetch(distance_r8, t + ivec3(1, 1, 0), 0).r);
    b = vec4(texelFetch(distance_r8, t + ivec3(0, 0, 1), 0).r, texelFetch(distance_r8, t + ivec3(1, 0, 1), 0).r,
             texelFetch(distance_r8, t + ivec3(0, 1, 1), 0).r, texelFetch(distance_r8, t + ivec3(1, 1, 1), 0).r);
  }
  a *= level.scale.y;
  b *= level.scale.y;
}

// Distance in level voxels anywhere in the grid; in empty cells the bound.
float fieldDistance(SdfLevel level, vec3 pointLevel) {
  vec3 p = clamp(pointLevel, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
  ivec3 brick = brickOfPoint(level, p);
  uint cell = cellOfBrick(level.cells.x, level, brick);
  if ((cell & CELL_EMPTY) != 0u) return boundOfCell(cell);
  return brickDistance(level, cell, p - vec3(brick) * float(BRICK_CELLS));
}

// Gradient by central differences over 2 * radius level voxels. Every stored brick has its neighbours stored wherever
// the surface is within a voxel of them, so that a radius up to one voxel reads stored distances only.
vec3 fieldGradient(SdfLevel level, vec3 pointLevel, float radius) {
  vec2 r = vec2(radius, 0.0);
  return vec3(fieldDistance(level, pointLevel + r.xyy) - fieldDistance(level, pointLevel - r.xyy),
              fieldDistance(level, pointLevel + r.yxy) - fieldDistance(level, pointLevel - r.yxy),
              fieldDistance(level, pointLevel + r.yyx) - fieldDistance(level, pointLevel - r.yyx));
}
