// How a triangle leaves its keys; for the passes that splat small triangles and parts of large ones.
#include "lib/field_keys.glsl"

layout(std430, binding = kFieldKeyBinding) buffer KeyBlock { uint keys[]; };
layout(std430, binding = kFieldTileBinding) readonly buffer TileBlock { FieldTile tiles[]; };

struct SplatTriangle {
  uint number;
  vec3 a, b, c; // texels
  float extra;  // texels that its rank lies above its distance
};

SplatTriangle splatTriangle(FieldCascade cascade, uint number) {
  WorldTriangle t = triangles[number];
  bool isClosed = (t.codes.w & WORLD_TRIANGLE_CLOSED) != 0u;
  float perMetre = cascade.texel.y;
  return SplatTriangle(number, t.a.xyz * perMetre, t.b.xyz * perMetre, t.c.xyz * perMetre,
                       isClosed ? cascade.texel.w : 0.0);
}

// Texels whose centres may be within reach, of those that are made anew; upper is included.
void splatBounds(uint cascadeIndex, SplatTriangle t, out ivec3 lower, out ivec3 upper) {
  ivec3 first = field.splatMin[cascadeIndex].xyz, last = field.splatMax[cascadeIndex].xyz;
  vec3 low = min(t.a, min(t.b, t.c)) - (SPLAT_TEXELS + 0.5), high = max(t.a, max(t.b, t.c)) + (SPLAT_TEXELS - 0.5);
  // Clamped as floats first: what lies far away is no number that an int holds.
  lower = max(ivec3(clamp(ceil(low), vec3(first - 1), vec3(last + 1))), first);
  upper = min(ivec3(clamp(floor(high), vec3(first - 1), vec3(last + 1))), last);
}

void splatTexel(FieldCascade cascade, SplatTriangle t, ivec3 lattice) {
  float squared = squaredTriangleDistance(vec3(lattice) + 0.5, t.a, t.b, t.c);
  if (squared > SPLAT_TEXELS * SPLAT_TEXELS) return;
  uint slot = tileSlot(cascade, lattice >> 3);
  if (tiles[cascade.buffers.z + slot].update != field.counts.w) return; // it is as it was
  uint word = cascade.buffers.x + slot * FIELD_TILE_TEXELS + indexInTile(lattice, int(FIELD_TILE));
  uint key = keyOf(sqrt(squared) + t.extra, t.number);
  if (key < keys[word]) atomicMin(keys[word], key); // an old value can only be larger: most are spared the atomic
}
