// SDF objects in the world field: a lower bound of the distance to an object from its bricks.
#include "lib/bricks.glsl"

// Level voxels up to which a stored distance of the band is not clamped, of four.
const float TRUSTED_VOXELS = 3.9;

// Distance in grid voxels at a point of the box, from the finest level not below `firstLevel` that holds a distance
// there and no clamp; the coarsest is clamped nowhere.
float objectDistanceGrid(SdfInstance instance, vec3 pointGrid, int firstLevel) {
  int last = instance.ids.z - 1;
  for (int i = min(firstLevel, last); i < last; ++i) {
    SdfLevel level = sdfLevels[instance.ids.y + i];
    vec3 p = clamp(pointGrid * level.scale.x, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
    ivec3 brick = brickOfPoint(level, p);
    uint cell = cellOfBrick(level.cells.x, level, brick);
    if ((cell & CELL_EMPTY) != 0u) continue;
    float voxels = brickDistance(level, cell, p - vec3(brick) * float(BRICK_CELLS));
    if (abs(voxels) < TRUSTED_VOXELS) return voxels / level.scale.x;
  }
  SdfLevel level = sdfLevels[instance.ids.y + last];
  return fieldDistance(level, pointGrid * level.scale.x) / level.scale.x;
}

vec3 gridPoint(SdfInstance instance, vec3 pointWorld) {
  vec4 h = vec4(pointWorld, 1.0);
  return vec3(dot(instance.gridFromWorld[0], h), dot(instance.gridFromWorld[1], h), dot(instance.gridFromWorld[2], h));
}

// Lower bound, metres, of the distance to the object's box; may be less where the transform is no similarity.
float boxDistance(SdfInstance instance, vec3 pointWorld) {
  vec3 p = gridPoint(instance, pointWorld);
  return instance.boxMax.w * distance(p, clamp(p, instance.boxMin.xyz, instance.boxMax.xyz));
}

// Lower bound, metres, of the signed distance to the object. Outside of the box, with q its closest point there:
// sqrt(max(I(q), 0)^2 + |p - q|^2) in grid voxels, because the box is convex and angle(p, q, surface) is no less than a
// right one; times the least metres of a voxel.
float objectDistance(SdfInstance instance, vec3 pointWorld, int firstLevel) {
  vec3 p = gridPoint(instance, pointWorld);
  vec3 q = clamp(p, instance.boxMin.xyz, instance.boxMax.xyz);
  float inner = objectDistanceGrid(instance, q, firstLevel);
  float outer = distance(p, q);
  return instance.boxMax.w * (outer > 0.0 ? length(vec2(max(inner, 0.0), outer)) : inner);
}

// The level to begin with for texels of a size: its voxels are at most half as large.
int firstLevelFor(SdfInstance instance, float texelMetres) {
  return int(clamp(floor(log2(texelMetres / instance.boxMin.w)) - 1.0, 0.0, float(instance.ids.z - 1)));
}
