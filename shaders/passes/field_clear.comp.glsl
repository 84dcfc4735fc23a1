// Forgets the keys of the tiles that are made anew, stamps them with the number of the update, and empties the list of
// large triangles.
#include "lib/field_grid.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldKeyBinding) writeonly buffer KeyBlock { uvec4 keys[]; };
layout(std430, binding = kFieldSplatBinding) writeonly buffer PartBlock { uint partCount; };
layout(std430, binding = kFieldTileBinding) writeonly buffer TileBlock { FieldTile tiles[]; };

uniform uint listLength;

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  if (index == 0u && gl_LocalInvocationIndex == 0u) partCount = 0u;
  uint slot = listed[index] & 0xffffffu;
  FieldCascade cascade = field.cascades[listed[index] >> 24];
  uint first = (cascade.buffers.x + slot * FIELD_TILE_TEXELS) / 4u;
  keys[first + gl_LocalInvocationIndex] = uvec4(FIELD_NONE);
  if (gl_LocalInvocationIndex == 0u) tiles[cascade.buffers.z + slot].update = field.counts.w;
}
