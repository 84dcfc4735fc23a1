// Signed values of the coarse texels, from their candidates; tiles that nothing reaches are left to field_sides.
//
// Signs: near surfaces the pseudonormal of what is nearest tells. Farther away the candidate may not quite be the
// nearest and its pseudonormal point anywhere; but the ball around the texel up to the surface holds no other surface,
// so a texel before the surface, on the way to the candidate, has the same sign.
#include "lib/field_band.glsl"
#include "lib/field_far.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldCandidateBinding) buffer CandidateBlock { uint candidates[]; };
layout(std430, binding = kFieldSideBinding) writeonly buffer SideBlock { uint sides[]; };

uniform uint listLength;

shared float values[COARSE_TILE_TEXELS];

float valueAt(FieldCascade cascade, ivec3 coarse, uint triangle) {
  if (triangle == FIELD_NONE) return UNKNOWN_TEXELS;
  WorldTriangle t = triangles[triangle];
  vec3 point = coarseCenter(cascade, coarse);
  TriangleHit hit = closestOnTriangle(point, t.a.xyz, t.b.xyz, t.c.xyz);
  float sheetTexels = isClosed(t) ? 0.0 : cascade.texel.w;
  float texels = max(sqrt(hit.squared) * cascade.texel.y - sheetTexels, 1e-3); // it has a sign
  return isInsideFar(cascade, t, point, hit) ? -texels : sureTexels(texels, sheetTexels);
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u && !isReachedTile(tiles[tile.word])) sides[tile.word] = FIELD_SIDE_UNKNOWN;
  ivec3 coarse = tile.firstTexel / COARSE + cubeIndex(int(thread), COARSE_TILE);
  uint word = coarseWord(cascade, coarse);
  values[thread] = valueAt(cascade, coarse, candidates[word]);
  barrier();
  if ((thread & 1u) == 0u)
    candidates[coarseDistanceWord(word)] = packHalf2x16(vec2(values[thread], values[thread + 1u]));
}
