// One sweep over the coarse texels of a tile; run for x, y and z. Along the axis whole tiles are asked, the nearest
// first, so that one address serves four texels.
#include "lib/field_grid.glsl"
#include "lib/field_sweep.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldSeedBinding) readonly buffer SeedBlock { uint seeds[]; };
// A texel's own bits change while neighbours read the bits of the sweep before, which stay the same.
layout(std430, binding = kFieldSweepBinding) buffer SweepBlock { uint sweeps[]; };

layout(std430, binding = kFieldTileBinding) buffer TileBlock { FieldTile tiles[]; };

uniform uint listLength;
uniform int axis;

const int MOST_TILES_AWAY = 3; // for the longest reach, fieldSweepReach(16)
// Of the tiles from MOST_TILES_AWAY before to as many behind: whether anything is to be found there.
shared bool isFull[2 * MOST_TILES_AWAY + 1];
shared uint found; // by this tile

const int NOTHING = 1 << 20; // no seed within reach

struct Best {
  int cost; // squared coarse texels
  int offset;
  uint word; // what the sweeps before found there
};

// The four coarse texels from `first` on, `stride` words apart, the first of them `offset` away.
void askTile(uint first, uint stride, int offset, int reach, inout Best best) {
  for (int i = 0; i < COARSE_TILE; ++i) {
    uint word = first + uint(i) * stride;
    uint found = axis == 0 ? 0u : sweeps[word];
    int before = axis == 0 ? (seeds[word] != FIELD_NONE ? 0 : NOTHING) : sweepCost(found, axis);
    int away = offset + i, cost = before + away * away;
    // Ties go to the lower offset, whatever the order of asking.
    if (abs(away) > reach || cost > best.cost || (cost == best.cost && away >= best.offset)) continue;
    best = Best(cost, away, found);
  }
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  ivec3 inTile = cubeIndex(int(gl_LocalInvocationIndex), COARSE_TILE);
  uint own = coarseWord(cascade, tile.firstTexel / COARSE + inTile);
  uint stride = axis == 0 ? 1u : axis == 1 ? uint(COARSE_TILE) : uint(COARSE_TILE * COARSE_TILE);
  int at = inTile[axis];
  uint first = own - uint(at) * stride;

  int count = cascade.window.w >> 3, inWindow = (tile.firstTexel[axis] - cascade.window[axis]) >> 3;
  int slot = (tile.firstTexel[axis] >> 3) & (count - 1);
  int slotStride = axis == 0 ? 1 : axis == 1 ? count : count * count;
  if (gl_LocalInvocationIndex == 0u) found = 0u;
  if (gl_LocalInvocationIndex <= 2u * uint(MOST_TILES_AWAY)) {
    int away = int(gl_LocalInvocationIndex) - MOST_TILES_AWAY, other = inWindow + away;
    int word = int(tile.word) + (((slot + away) & (count - 1)) - slot) * slotStride;
    isFull[gl_LocalInvocationIndex] = other >= 0 && other < count && tiles[word].found[axis] != 0u;
  }
  barrier();

  int reach = sweepReach(cascade);
  Best best = Best(NOTHING, 0, 0u);
  if (isFull[MOST_TILES_AWAY]) askTile(first, stride, -at, reach, best);
  for (int away = 1; away <= MOST_TILES_AWAY; ++away) {
    // Of the tiles at this distance the nearest texels of all.
    int before = at + 1 + (away - 1) * COARSE_TILE, behind = away * COARSE_TILE - at;
    int least = min(before, behind);
    if (least > reach || least * least > best.cost) break;
    for (int side = -1; side <= 1; side += 2) {
      if (!isFull[MOST_TILES_AWAY + side * away]) continue;
      int slots = ((slot + side * away) & (count - 1)) - slot;
      uint there = first + uint(slots * slotStride) * COARSE_TILE_TEXELS;
      askTile(there, stride, side * away * COARSE_TILE - at, reach, best);
    }
  }
  uint word = axis == 0 ? 0u : sweeps[own];
  if (best.cost < NOTHING) {
    word = sweepResult(word, best.word, best.offset, axis);
    found = 1u;
  } else { // nothing of this or a later sweep
    word &= axis == 1 ? SWEEP_MASK : axis == 2 ? ~(SWEEP_MASK << SWEEP_Z_SHIFT) : 0u;
  }
  sweeps[own] = word;
  barrier();
  if (axis < 2 && gl_LocalInvocationIndex == 0u) tiles[tile.word].found[axis + 1] = found;
}
