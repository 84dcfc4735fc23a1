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

const int COARSE_APRON = COARSE_TILE + 2, COARSE_PLACES = COARSE_APRON * COARSE_APRON * COARSE_APRON;
const int KEY_APRON = int(FIELD_TILE) + 2, RIM_ROUNDS = (TILE_RIM + int(OPEN_THREADS) - 1) / int(OPEN_THREADS);
// From a texel's centre to its coarse one's half the diagonal of a texel; and what coarse candidates may err by.
const float COARSE_AWAY_TEXELS = 0.8660255 + 0.25;
shared uint coarseIds[COARSE_PLACES];
shared float coarseRanks[COARSE_TILE * COARSE_TILE * COARSE_TILE]; // texels
shared uint keyIds[KEY_APRON * KEY_APRON * KEY_APRON];
shared uint keyRows[KEY_APRON * KEY_APRON]; // a bit for each of a row along x: it has a key

int keyPlace(ivec3 at) { return (at.z * KEY_APRON + at.y) * KEY_APRON + at.x; }

// All reads stand before what is done with them: they are waited for once, those in a loop one after the other.
void load(ListedTile tile, FieldCascade cascade) {
  int thread = int(gl_LocalInvocationIndex);
  if (thread == 0) openCount = lastOpenCount = 0u;
  ivec3 firstCoarse = tile.firstTexel / COARSE, coarse = firstCoarse - 1 + cubeIndex(thread, COARSE_APRON);
  uint coarseId = isInWindow(cascade, coarse * COARSE) ? candidates[coarseWord(cascade, coarse)] : FIELD_NONE;
  uint pair = uint(thread) % (COARSE_TILE_TEXELS / 2u);
  vec2 ranks = unpackHalf2x16(candidates[coarseDistanceWord(coarseWord(cascade, firstCoarse) + 2u * pair)]);
  uint own[OWN_TEXELS], rim[RIM_ROUNDS];
  int rimPlaces[RIM_ROUNDS];
  for (int k = 0; k < OWN_TEXELS; ++k)
    own[k] = keys[tile.word * FIELD_TILE_TEXELS + uint(k) * OPEN_THREADS + uint(thread)];
  for (int k = 0; k < RIM_ROUNDS; ++k) {
    ivec3 at = rimPlace(min(k * int(OPEN_THREADS) + thread, TILE_RIM - 1)), lattice = tile.firstTexel - 1 + at;
    rimPlaces[k] = keyPlace(at);
    rim[k] = isInWindow(cascade, lattice) ? keys[texelWord(cascade, lattice)] : FIELD_NONE;
  }
  if (thread < COARSE_PLACES) coarseIds[thread] = coarseId;
  coarseRanks[2u * pair] = ranks.x, coarseRanks[2u * pair + 1u] = ranks.y;
  for (int k = 0; k < OWN_TEXELS; ++k) {
    int place = keyPlace(cubeIndex(k * int(OPEN_THREADS) + thread, int(FIELD_TILE)) + 1);
    keyIds[place] = isKey(own[k]) ? triangleOfWord(own[k]) : FIELD_NONE;
  }
  for (int k = 0; k < RIM_ROUNDS; ++k) keyIds[rimPlaces[k]] = isKey(rim[k]) ? triangleOfWord(rim[k]) : FIELD_NONE;
  barrier();
  if (thread < KEY_APRON * KEY_APRON) {
    uint row = 0u;
    for (int x = 0; x < KEY_APRON; ++x)
      if (keyIds[thread * KEY_APRON + x] != FIELD_NONE) row |= 1u << x;
    keyRows[thread] = row;
  }
  barrier();
}

// Whether any of the 27 texels around one, or of a row of three of them, has a key.
bool isKeyInRow(ivec3 at, int y, int z) { return (keyRows[(at.z + z) * KEY_APRON + at.y + y] >> at.x & 7u) != 0u; }
bool isKeyAround(ivec3 at) {
  uint columns = 0u;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y) columns |= keyRows[(at.z + z) * KEY_APRON + at.y + y];
  return (columns >> at.x & 7u) != 0u;
}

uint nearestOfKeys(ivec3 at, vec3 point, float sheetHalf) {
  Nearest nearest = Nearest(FIELD_NONE, 1e30);
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y) {
      if (!isKeyInRow(at, y, z)) continue;
      int row = keyPlace(at + ivec3(0, y, z));
      for (int x = 0; x < 3; ++x) consider(keyIds[row + x], point, sheetHalf, nearest);
    }
  return nearest.triangle;
}

uint nearestOfCandidates(ivec3 at, vec3 point, float sheetHalf) {
  Nearest nearest = Nearest(FIELD_NONE, 1e30);
  ivec3 coarse = (at + 1) >> 1; // the lowest of the eight, in the apron
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 c = coarse + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    consider(coarseIds[(c.z * COARSE_APRON + c.y) * COARSE_APRON + c.x], point, sheetHalf, nearest);
  }
  return nearest.triangle;
}

void evaluateTile(ListedTile tile) {
  FieldCascade cascade = field.cascades[tile.cascade];
  load(tile, cascade);
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  uint nearKeys = 0u, farFromKeys = 0u; // texels without a key
  for (int k = 0; k < OWN_TEXELS; ++k) {
    int i = k * int(OPEN_THREADS) + int(gl_LocalInvocationIndex);
    ivec3 at = cubeIndex(i, int(FIELD_TILE));
    if (keyIds[keyPlace(at + 1)] != FIELD_NONE) continue;
    ivec3 coarse = at >> 1;
    if (coarseRanks[(coarse.z * COARSE_TILE + coarse.y) * COARSE_TILE + coarse.x] <= FINE_TEXELS + COARSE_AWAY_TEXELS) {
      if (isKeyAround(at)) nearKeys |= 1u << k;
      else farFromKeys |= 1u << k;
    } else {
      keys[tile.word * FIELD_TILE_TEXELS + uint(i)] = FIELD_NONE;
    }
  }
  listOpen(nearKeys);
  listLastOpen(farFromKeys);
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < openCount + lastOpenCount; i += OPEN_THREADS) {
    bool isNear = i < openCount;
    uint texel = isNear ? open[i] : lastOpen(i - openCount);
    ivec3 at = cubeIndex(int(texel), int(FIELD_TILE));
    vec3 point = texelCenter(cascade, tile.firstTexel + at);
    uint found = isNear ? nearestOfKeys(at, point, sheetHalf) : nearestOfCandidates(at, point, sheetHalf);
    keys[tile.word * FIELD_TILE_TEXELS + texel] = foundWordOf(found);
  }
}

void main() {
  for (uint at = gl_WorkGroupID.x; at < bandCount; at += gl_NumWorkGroups.x) {
    evaluateTile(listedTile(band[at]));
    barrier();
  }
}
