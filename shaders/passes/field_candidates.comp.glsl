// The triangle of each coarse texel: the nearest of those that its own nearest seed and those of its six neighbours name.
#include "lib/field_band.glsl"
#include "lib/field_candidates.glsl"
#include "lib/field_grid.glsl"
#include "lib/field_sweep.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldSeedBinding) readonly buffer SeedBlock { uint seeds[]; };
layout(std430, binding = kFieldSweepBinding) readonly buffer SweepBlock { uint sweeps[]; };
layout(std430, binding = kFieldCandidateBinding) writeonly buffer CandidateBlock { uint candidates[]; };
layout(std430, binding = kFieldTileBinding) buffer TileBlock { FieldTile tiles[]; };

layout(std430, binding = kFieldNewBandBinding) buffer BandBlock {
  uint bandCount;
  uint band[]; // words as those of lists, in whatever order
};

uniform uint listLength;

const int APRON = COARSE_TILE + 2;
shared uint named[APRON * APRON * APRON];
const float MOST_HALF = 65504.0;
// Along an axis, from a surface to the centre of the coarse texel that it seeds: field_seeds lets it pass by the centre of
// a texel so far, and half a texel from there.
const float SEED_AWAY_TEXELS = 0.8760255 + 0.5;
shared float ranks[COARSE_TILE_TEXELS]; // texels
shared uint leastBits, leastTexel;

// Reads of one kind stand together: they are waited for once, those in a loop one after the other.
//
// lowest  coarse texel of the apron
void load(FieldCascade cascade, ivec3 lowest) {
  const int PLACES = APRON * APRON * APRON, ROUNDS = (PLACES + 63) / 64;
  int thread = int(gl_LocalInvocationIndex);
  ivec3 coarse[ROUNDS];
  uint words[ROUNDS];
  for (int k = 0; k < ROUNDS; ++k) {
    coarse[k] = lowest + cubeIndex(k * 64 + thread, APRON);
    words[k] = isInWindow(cascade, coarse[k] * COARSE) ? sweeps[coarseWord(cascade, coarse[k])] : 0u;
  }
  for (int k = 0; k < ROUNDS; ++k)
    words[k] = hasSeed(words[k]) ? seeds[coarseWord(cascade, coarse[k] + seedOffset(words[k]))] : FIELD_NONE;
  for (int k = 0; k < ROUNDS; ++k)
    if (k * 64 + thread < PLACES) named[k * 64 + thread] = words[k];
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  ivec3 first = tile.firstTexel / COARSE;
  if (gl_LocalInvocationIndex == 0u) leastBits = 0x7f800000u, leastTexel = 64u; // infinity
  load(cascade, first - 1);
  barrier();
  ivec3 at = cubeIndex(int(gl_LocalInvocationIndex), COARSE_TILE);
  vec3 point = coarseCenter(cascade, first + at);
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  Nearest nearest = Nearest(FIELD_NONE, 1e30);
  int own = ((at.z + 1) * APRON + at.y + 1) * APRON + at.x + 1;
  consider(named[own], point, sheetHalf, nearest);
  for (int step = 1; step < APRON * APRON * APRON; step *= APRON) { // those farther away add little
    consider(named[own - step], point, sheetHalf, nearest);
    consider(named[own + step], point, sheetHalf, nearest);
  }
  // Farther away what is nearest may lie outside the sweeps' window. It is farther than the coarse texels of a tile and
  // those beside it lie apart, 13.9: what has no candidate there has the sign of the tile's nearest to a surface.
  if (nearest.rank * cascade.texel.y > float(COARSE * sweepReach(cascade)) - SEED_AWAY_TEXELS) nearest.triangle = FIELD_NONE;
  uint word = coarseWord(cascade, first + at);
  candidates[word] = nearest.triangle;
  float rank = nearest.triangle == FIELD_NONE ? MOST_HALF : nearest.rank * cascade.texel.y;
  ranks[gl_LocalInvocationIndex] = rank;
  // Positive floats are ordered as their bits.
  uint bits = floatBitsToUint(rank);
  if (nearest.triangle != FIELD_NONE) atomicMin(leastBits, bits);
  barrier();
  if ((gl_LocalInvocationIndex & 1u) == 0u)
    candidates[coarseDistanceWord(word)] = packHalf2x16(vec2(rank, ranks[gl_LocalInvocationIndex + 1u]));
  bool isLeast = nearest.triangle != FIELD_NONE && bits == leastBits;
  if (isLeast) atomicMin(leastTexel, gl_LocalInvocationIndex);
  barrier();
  if (leastBits == 0x7f800000u ? gl_LocalInvocationIndex == 0u : leastTexel == gl_LocalInvocationIndex) {
    tiles[tile.word].nearest = nearest.triangle;
    tiles[tile.word].nearestBits = leastBits;
    tiles[tile.word].nearestTexel = gl_LocalInvocationIndex;
    if (isBandTile(tiles[tile.word])) band[atomicAdd(bandCount, 1u)] = listed[index];
  }
}
