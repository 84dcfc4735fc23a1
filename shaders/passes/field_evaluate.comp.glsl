// First round at full resolution, in the band: each texel's nearest of the 27 keys around it, where there are none of
// the eight coarse candidates.
#include "lib/field_band.glsl"
#include "lib/field_keys.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldKeyBinding) readonly buffer KeyBlock { uint keys[]; };
layout(std430, binding = kFieldIdBinding) writeonly buffer IdBlock { uint ids[]; };
layout(std430, binding = kFieldCandidateBinding) readonly buffer CandidateBlock { uint candidates[]; };
layout(std430, binding = kFieldTileBinding) readonly buffer TileBlock { FieldTile tiles[]; };

uniform uint listLength;

const int COARSE_APRON = COARSE_TILE + 2;
const int KEY_APRON = int(FIELD_TILE) + 2;
shared uint coarseIds[COARSE_APRON * COARSE_APRON * COARSE_APRON];
shared uint keyIds[KEY_APRON * KEY_APRON * KEY_APRON];

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  if (!isBandTile(tiles[tile.word])) return;
  int thread = int(gl_LocalInvocationIndex);
  for (int i = thread; i < COARSE_APRON * COARSE_APRON * COARSE_APRON; i += 128) {
    ivec3 coarse = tile.firstTexel / COARSE - 1 + cubeIndex(i, COARSE_APRON);
    coarseIds[i] = isInWindow(cascade, coarse * COARSE) ? candidates[coarseWord(cascade, coarse)] : FIELD_NONE;
  }
  for (int i = thread; i < KEY_APRON * KEY_APRON * KEY_APRON; i += 128) {
    ivec3 lattice = tile.firstTexel - 1 + cubeIndex(i, KEY_APRON);
    keyIds[i] = isInWindow(cascade, lattice) ? triangleOfKey(keys[texelWord(cascade, lattice)]) : FIELD_NONE;
  }
  barrier();
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (int i = thread; i < int(FIELD_TILE_TEXELS); i += 128) {
    ivec3 at = cubeIndex(i, int(FIELD_TILE));
    vec3 point = texelCenter(cascade, tile.firstTexel + at);
    Nearest nearest = Nearest(FIELD_NONE, 1e30);
    ivec3 coarse = (at + 1) >> 1; // the lowest of the eight, in the apron
    consider(keyIds[((at.z + 1) * KEY_APRON + at.y + 1) * KEY_APRON + at.x + 1], point, sheetHalf, nearest);
    for (int n = 0; n < 27; ++n) {
      ivec3 k = at + ivec3(n % 3, n / 3 % 3, n / 9);
      consider(keyIds[(k.z * KEY_APRON + k.y) * KEY_APRON + k.x], point, sheetHalf, nearest);
    }
    bool isNear = nearest.triangle != FIELD_NONE; // keys say enough
    for (int corner = 0; corner < 8 && !isNear; ++corner) {
      ivec3 c = coarse + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      consider(coarseIds[(c.z * COARSE_APRON + c.y) * COARSE_APRON + c.x], point, sheetHalf, nearest);
    }
    ids[tile.word * FIELD_TILE_TEXELS + uint(i)] = nearest.triangle;
  }
}
