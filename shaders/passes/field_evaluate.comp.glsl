// The band at full resolution, first round: nearest triangles. A texel with a key has its own, to a quantum of the key's
// distance. One without takes the nearest of the 27 keys around it, where there are none of the eight coarse
// candidates. Texels farther away than matters here are left to field_far.
#include "lib/field_band.glsl"
#include "lib/field_keys.glsl"
#include "lib/field_open.glsl"

layout(local_size_x = OPEN_THREADS) in;

layout(std430, binding = kFieldBandBinding) readonly buffer BandBlock {
  uint bandCount;
  uint band[]; // words as those of lists, in whatever order
};
layout(std430, binding = kFieldKeyBinding) buffer KeyBlock { uint keys[]; }; // what other groups find here is no key
layout(std430, binding = kFieldCandidateBinding) readonly buffer CandidateBlock { uint candidates[]; };

const int COARSE_APRON = COARSE_TILE + 2;
const int KEY_APRON = int(FIELD_TILE) + 2;
// From a texel's centre to its coarse one's half the diagonal of a texel; and what coarse candidates may err by.
const float COARSE_AWAY_TEXELS = 0.8660255 + 0.25;
shared uint coarseIds[COARSE_APRON * COARSE_APRON * COARSE_APRON];
shared float coarseRanks[COARSE_TILE * COARSE_TILE * COARSE_TILE]; // texels
shared uint keyIds[KEY_APRON * KEY_APRON * KEY_APRON];

void load(ListedTile tile, FieldCascade cascade) {
  int thread = int(gl_LocalInvocationIndex);
  if (thread == 0) openCount = 0u;
  ivec3 firstCoarse = tile.firstTexel / COARSE;
  for (int i = thread; i < COARSE_APRON * COARSE_APRON * COARSE_APRON; i += int(OPEN_THREADS)) {
    ivec3 coarse = firstCoarse - 1 + cubeIndex(i, COARSE_APRON);
    coarseIds[i] = isInWindow(cascade, coarse * COARSE) ? candidates[coarseWord(cascade, coarse)] : FIELD_NONE;
  }
  if (thread < int(COARSE_TILE_TEXELS) / 2) {
    vec2 pair = unpackHalf2x16(candidates[coarseDistanceWord(coarseWord(cascade, firstCoarse) + 2u * uint(thread))]);
    coarseRanks[2 * thread] = pair.x, coarseRanks[2 * thread + 1] = pair.y;
  }
  for (int i = thread; i < KEY_APRON * KEY_APRON * KEY_APRON; i += int(OPEN_THREADS)) {
    ivec3 lattice = tile.firstTexel - 1 + cubeIndex(i, KEY_APRON);
    uint word = isInWindow(cascade, lattice) ? keys[texelWord(cascade, lattice)] : FIELD_NONE;
    keyIds[i] = isKey(word) ? triangleOfWord(word) : FIELD_NONE;
  }
  barrier();
}

uint nearestAround(ivec3 at, vec3 point, float sheetHalf) {
  Nearest nearest = Nearest(FIELD_NONE, 1e30);
  int lowest = (at.z * KEY_APRON + at.y) * KEY_APRON + at.x; // of the 27
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y) {
      int row = lowest + (z * KEY_APRON + y) * KEY_APRON;
      for (int x = 0; x < 3; ++x) consider(keyIds[row + x], point, sheetHalf, nearest);
    }
  bool isNear = nearest.triangle != FIELD_NONE; // keys say enough
  ivec3 coarse = (at + 1) >> 1;                 // the lowest of the eight, in the apron
  for (int corner = 0; corner < 8 && !isNear; ++corner) {
    ivec3 c = coarse + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    consider(coarseIds[(c.z * COARSE_APRON + c.y) * COARSE_APRON + c.x], point, sheetHalf, nearest);
  }
  return nearest.triangle;
}

void evaluateTile(ListedTile tile) {
  FieldCascade cascade = field.cascades[tile.cascade];
  load(tile, cascade);
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  uint mine = 0u; // texels without a key
  for (int k = 0; k < OWN_TEXELS; ++k) {
    int i = k * int(OPEN_THREADS) + int(gl_LocalInvocationIndex);
    ivec3 at = cubeIndex(i, int(FIELD_TILE));
    uint triangle = keyIds[((at.z + 1) * KEY_APRON + at.y + 1) * KEY_APRON + at.x + 1];
    if (triangle != FIELD_NONE) continue;
    ivec3 coarse = at >> 1;
    if (coarseRanks[(coarse.z * COARSE_TILE + coarse.y) * COARSE_TILE + coarse.x] <= FINE_TEXELS + COARSE_AWAY_TEXELS) {
      mine |= 1u << k;
    } else {
      keys[tile.word * FIELD_TILE_TEXELS + uint(i)] = FIELD_NONE;
    }
  }
  listOpen(mine);
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < openCount; i += OPEN_THREADS) {
    ivec3 at = cubeIndex(int(open[i]), int(FIELD_TILE));
    keys[tile.word * FIELD_TILE_TEXELS + open[i]] =
        foundWordOf(nearestAround(at, texelCenter(cascade, tile.firstTexel + at), sheetHalf));
  }
}

void main() {
  for (uint at = gl_WorkGroupID.x; at < bandCount; at += gl_NumWorkGroups.x) {
    evaluateTile(listedTile(band[at]));
    barrier();
  }
}
