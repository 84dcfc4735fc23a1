// Surface attributes that a level's bricks store.
#include "lib/bricks.glsl"

struct BrickAttributes {
  vec4 colorAndCoverage; // linear
  vec4 material;         // metallic, roughness, occlusion; a: over one half where unlit (card_crossing.glsl)
  vec3 emission;
};

// Where a point's attributes stand in the pool, as texture coordinates. Returns false where none are stored.
bool findAttributes(SdfLevel level, vec3 pointLevel, out vec3 uvw) {
  if (level.attributes.x == SDF_NO_ATTRIBUTES) return false;
  vec3 p = clamp(pointLevel, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
  ivec3 brick = brickOfPoint(level, p);
  uint slot = cellOfBrick(level.attributes.x, level, brick);
  if ((slot & CELL_EMPTY) != 0u) return false;
  ivec3 size = textureSize(brick_base_color, 0);
  uvw = (vec3(texelOfSlot(slot)) + (p - vec3(brick) * float(BRICK_CELLS)) + 0.5) / vec3(size);
  return true;
}

// White and rough where none are stored: then it returns false.
bool readAttributes(SdfLevel level, vec3 pointLevel, out BrickAttributes found) {
  found = BrickAttributes(vec4(1.0), vec4(0.0, 1.0, 1.0, 0.0), vec3(0.0));
  vec3 uvw;
  if (!findAttributes(level, pointLevel, uvw)) return false;
  found = BrickAttributes(textureLod(brick_base_color, uvw, 0.0), textureLod(brick_material, uvw, 0.0), textureLod(brick_emission, uvw, 0.0).rgb);
  return true;
}

// 0 where none is stored.
float coverageAt(SdfLevel level, vec3 pointLevel) {
  vec3 uvw;
  return findAttributes(level, pointLevel, uvw) ? textureLod(brick_base_color, uvw, 0.0).a : 0.0;
}
