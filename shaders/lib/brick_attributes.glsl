// Surface attributes that a level's bricks store.
#include "lib/bricks.glsl"

struct BrickAttributes {
  vec4 colorAndCoverage; // linear
  vec4 material;         // metallic, roughness, occlusion, unlit
  vec3 emission;
};

// White and rough where none are stored: then it returns false.
bool readAttributes(SdfLevel level, vec3 pointLevel, out BrickAttributes found) {
  found = BrickAttributes(vec4(1.0), vec4(0.0, 1.0, 1.0, 0.0), vec3(0.0));
  if (level.attributes.x == SDF_NO_ATTRIBUTES) return false;
  vec3 p = clamp(pointLevel, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
  ivec3 brick = brickOfPoint(level, p);
  uint slot = cellOfBrick(level.attributes.x, level, brick);
  if ((slot & CELL_EMPTY) != 0u) return false;
  ivec3 size = textureSize(brick_base_color, 0);
  vec3 uvw = (vec3(texelOfSlot(slot)) + (p - vec3(brick) * float(BRICK_CELLS)) + 0.5) / vec3(size);
  found = BrickAttributes(textureLod(brick_base_color, uvw, 0.0), textureLod(brick_material, uvw, 0.0), textureLod(brick_emission, uvw, 0.0).rgb);
  return true;
}
