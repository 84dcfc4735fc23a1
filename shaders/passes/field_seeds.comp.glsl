// Coarse texels that the surface goes through, with the triangle nearest to the centre of one of their eight texels.
#include "lib/field_keys.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldKeyBinding) readonly buffer KeyBlock { uint keys[]; };
layout(std430, binding = kFieldSeedBinding) writeonly buffer SeedBlock { uint seeds[]; };
layout(std430, binding = kFieldTileBinding) buffer TileBlock { FieldTile tiles[]; };

uniform uint listLength;

shared uint found[2]; // a bit a coarse texel: a seed

// No surface passes farther from all texel centres; half a sheet more is the rank of closed ones.
const float TOUCHED_TEXELS = 0.8660255 + 0.5 + 0.01;

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  ivec3 coarse = tile.firstTexel / COARSE + cubeIndex(int(gl_LocalInvocationIndex), COARSE_TILE);
  if (gl_LocalInvocationIndex < 2u) found[gl_LocalInvocationIndex] = 0u;
  barrier();
  uint key = FIELD_NONE, first = texelWord(cascade, coarse * COARSE); // the other seven lie in the same tile
  for (uint i = 0u; i < 8u; ++i)
    key = min(key, keys[first + (i & 1u) + (i >> 1 & 1u) * FIELD_TILE + (i >> 2) * FIELD_TILE * FIELD_TILE]);
  bool isTouched = isKey(key) && rankTexelsOfKey(key) <= TOUCHED_TEXELS;
  seeds[coarseWord(cascade, coarse)] = isTouched ? triangleOfWord(key) : FIELD_NONE;
  if (isTouched) atomicOr(found[gl_LocalInvocationIndex >> 5u], 1u << (gl_LocalInvocationIndex & 31u));
  barrier();
  if (gl_LocalInvocationIndex == 0u) tiles[tile.word].found.xy = uvec2(found[0], found[1]);
}
