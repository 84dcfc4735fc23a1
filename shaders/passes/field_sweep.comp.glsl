// The nearest seed of each coarse texel of a tile: in its plane across z first, by the bits of the tiles around; then,
// in a run of its own, along z from what the planes have. Ties go to the lower offset.
#include "lib/field_grid.glsl"
#include "lib/field_sweep.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
// A texel's own bits change while neighbours read those of its plane, which stay the same.
layout(std430, binding = kFieldSweepBinding) buffer SweepBlock { uint sweeps[]; };
layout(std430, binding = kFieldTileBinding) buffer TileBlock { FieldTile tiles[]; };
layout(std430, binding = kFieldNewBandBinding) buffer BandBlock { uint bandCount; };

uniform uint listLength;
uniform bool isDepth; // the second run

const int MOST_TILES_AWAY = 3; // for the longest reach
const int TILES_ACROSS = 2 * MOST_TILES_AWAY + 1;
shared uvec2 seedBits[TILES_ACROSS * TILES_ACROSS];
// Of each row along x, those of a plane one after the other: a bit a coarse texel, the tile's own from bit 12 on.
shared uint rows[COARSE_TILE][COARSE_TILE * TILES_ACROSS];
shared bool isFull[TILES_ACROSS]; // any seed in the tiles that share y, or z
shared uint found;

const uint NOTHING = 1u << 20;

// Word of the tile that lies so many tiles from one in the list.
uint tileWordAway(ListedTile tile, FieldCascade cascade, ivec3 away, out bool isHere) {
  ivec3 other = (tile.firstTexel >> 3) + away;
  isHere = isInWindow(cascade, other << 3);
  return cascade.buffers.z + tileSlot(cascade, other);
}

void loadPlane(ListedTile tile, FieldCascade cascade) {
  int thread = int(gl_LocalInvocationIndex);
  if (thread < TILES_ACROSS) isFull[thread] = false;
  barrier();
  if (thread < TILES_ACROSS * TILES_ACROSS) {
    bool isHere;
    uint word = tileWordAway(tile, cascade, ivec3(thread % TILES_ACROSS, thread / TILES_ACROSS, 0) - ivec3(MOST_TILES_AWAY, MOST_TILES_AWAY, 0), isHere);
    uvec2 bits = isHere ? tiles[word].found.xy : uvec2(0u);
    seedBits[thread] = bits;
    if ((bits.x | bits.y) != 0u) isFull[thread / TILES_ACROSS] = true;
  }
  barrier();
  for (int i = thread; i < COARSE_TILE * COARSE_TILE * TILES_ACROSS; i += 64) {
    int z = i & 3, y = i >> 2, shift = (z & 1) * 16 + (y & 3) * 4;
    uint row = 0u;
    for (int x = 0; x < TILES_ACROSS; ++x) {
      uvec2 bits = seedBits[(y >> 2) * TILES_ACROSS + x];
      row |= ((z < 2 ? bits.x : bits.y) >> shift & 15u) << (4 * x);
    }
    rows[z][y] = row;
  }
  barrier();
}

void sweepPlane(ListedTile tile, FieldCascade cascade, uint own, int reach) {
  loadPlane(tile, cascade);
  ivec3 at = cubeIndex(int(gl_LocalInvocationIndex), COARSE_TILE);
  int middle = at.x + MOST_TILES_AWAY * COARSE_TILE, row = at.y + MOST_TILES_AWAY * COARSE_TILE;
  uint within = (1u << (2 * reach + 1)) - 1u << (middle - reach), lower = (2u << middle) - 1u;
  uint best = NOTHING << 10u; // cost, then the offset: what is least wins
  for (int k = 0; k < 2 * MOST_TILES_AWAY + 1; ++k) {
    int away = (k + 1 >> 1) * ((k & 1) == 0 ? 1 : -1);
    int least = away < 0 ? at.y + 1 + (-away - 1) * COARSE_TILE : away * COARSE_TILE - at.y;
    if (!isFull[away + MOST_TILES_AWAY] || (away != 0 && uint(least * least) > best >> 10u)) continue;
    for (int i = 0; i < COARSE_TILE; ++i) {
      int y = (away + MOST_TILES_AWAY) * COARSE_TILE + i, dy = y - row;
      uint bits = rows[at.z][y] & within;
      if (bits == 0u || abs(dy) > reach) continue;
      int before = findMSB(bits & lower), behind = findLSB(bits >> middle);
      int dx = before < 0 || (behind >= 0 && behind < middle - before) ? behind : before - middle;
      best = min(best, planeWord(uint(dx * dx + dy * dy), ivec2(dx, dy)));
    }
  }
  bool isFound = best < NOTHING << 10u;
  sweeps[own] = isFound ? best : NO_SEED_IN_PLANE << 10u;
  if (isFound) found = 1u;
  barrier();
  if (gl_LocalInvocationIndex == 0u) tiles[tile.word].found.z = found;
}

void sweepDepth(ListedTile tile, FieldCascade cascade, uint own, int reach) {
  int thread = int(gl_LocalInvocationIndex);
  if (thread < TILES_ACROSS) {
    bool isHere;
    uint word = tileWordAway(tile, cascade, ivec3(0, 0, thread - MOST_TILES_AWAY), isHere);
    isFull[thread] = isHere && tiles[word].found.z != 0u;
  }
  barrier();
  int at = thread / (COARSE_TILE * COARSE_TILE);
  uint first = own - uint(at * COARSE_TILE * COARSE_TILE);
  int count = cascade.window.w >> 3, slot = (tile.firstTexel.z >> 3) & (count - 1);
  uint best = NOTHING << 5u; // cost, then the offset along z
  for (int k = 0; k < 2 * MOST_TILES_AWAY + 1; ++k) {
    int away = (k + 1 >> 1) * ((k & 1) == 0 ? 1 : -1);
    int least = away < 0 ? at + 1 + (-away - 1) * COARSE_TILE : away * COARSE_TILE - at;
    if (!isFull[away + MOST_TILES_AWAY] || (away != 0 && uint(least * least) > best >> 5u)) continue;
    int slots = ((slot + away) & (count - 1)) - slot;
    uint there = first + uint(slots * count * count) * COARSE_TILE_TEXELS;
    uint words[COARSE_TILE];
    for (int i = 0; i < COARSE_TILE; ++i) words[i] = planeCost(sweeps[there + uint(i * COARSE_TILE * COARSE_TILE)]);
    for (int i = 0; i < COARSE_TILE; ++i) {
      int dz = away * COARSE_TILE + i - at;
      bool isSeen = words[i] != NO_SEED_IN_PLANE && abs(dz) <= reach;
      if (isSeen) best = min(best, words[i] + uint(dz * dz) << 5u | uint(dz + SWEEP_REACH));
    }
  }
  uint word = sweeps[own] & (1u << SWEEP_PLANE_BITS) - 1u;
  if (best < NOTHING << 5u) {
    int dz = int(best & 31u) - SWEEP_REACH, z = at + dz;
    int slots = ((slot + (z >> 2)) & (count - 1)) - slot;
    uint there = first + uint(slots * count * count) * COARSE_TILE_TEXELS + uint((z & 3) * COARSE_TILE * COARSE_TILE);
    word = seedWord(word, ivec3(planeOffset(sweeps[there]), dz));
  }
  sweeps[own] = word;
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  if (gl_LocalInvocationIndex == 0u) found = 0u;
  if (index == 0u && gl_LocalInvocationIndex == 0u) bandCount = 0u; // field_candidates will add to it
  uint own = coarseWord(cascade, tile.firstTexel / COARSE) + gl_LocalInvocationIndex;
  int reach = sweepReach(cascade);
  if (!isDepth) sweepPlane(tile, cascade, own, reach);
  else sweepDepth(tile, cascade, own, reach);
}
