// Surface attributes that a level's bricks store.
#include "lib/bricks.glsl"

struct BrickAttributes {
  vec4 colorAndCoverage; // linear
  vec4 material;         // metallic, roughness, occlusion; a: filtered codes of unlit and of cards, see isUnlit
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

// Whether most of the samples around a point are unlit. Cards keep their axes in the same byte, from one half on where they
// are unlit (card_crossing.glsl), so that filtered bytes say it only where all are 0 or all are 1.
bool isUnlit(SdfLevel level, vec3 pointLevel, BrickAttributes attributes) {
  vec3 uvw;
  if (attributes.material.a <= 0.0 || attributes.material.a >= 1.0 || !findAttributes(level, pointLevel, uvw)) return attributes.material.a > 0.5;
  vec3 texel = uvw * vec3(textureSize(brick_material, 0)) - 0.5, part = fract(texel);
  float share = 0.0;
  for (int i = 0; i < 8; ++i) {
    ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
    vec3 weights = mix(1.0 - part, part, vec3(corner));
    if (texelFetch(brick_material, ivec3(floor(texel)) + corner, 0).a > 0.5) share += weights.x * weights.y * weights.z;
  }
  return share > 0.5;
}

// 0 where none is stored.
float coverageAt(SdfLevel level, vec3 pointLevel) {
  vec3 uvw;
  return findAttributes(level, pointLevel, uvw) ? textureLod(brick_base_color, uvw, 0.0).a : 0.0;
}
