// Tiles that nothing reaches: the range, with the sign of the reached tile that is nearest along an axis. That one may lie
// anywhere, so after each update all tiles ask; those that hold another sign are written anew, and listed for SDF objects
// to join them once more.
#include "lib/field_band.glsl"
#include "lib/field_far.glsl"

const int TILES = 16, THREADS_OF_TILE = 8; // six of them look along an axis each
layout(local_size_x = TILES * THREADS_OF_TILE) in;

layout(std430, binding = kFieldCandidateBinding) readonly buffer CandidateBlock { uint candidates[]; };
layout(std430, binding = kFieldSideBinding) buffer SideBlock { uint sides[]; };
layout(std430, binding = kFieldFlipBinding) buffer FlipBlock {
  uint groupsX, groupsY, groupsZ; // of the dispatch over those listed
  uint flippedCount;
  uint flipped[]; // as words of the tile lists
};
#include "lib/field_coarse_values.glsl"

uniform uint tileCount; // of all cascades

const uint MOST_GROUPS = 32768u; // along one dimension
shared uint reached[TILES * THREADS_OF_TILE]; // tiles away << 3 | direction, FIELD_NONE without
shared uint written[TILES];                   // as words of the tile lists
shared uint writtenCount;

// The direction from the tile, 0 to 5, along which to look.
ivec3 stepOf(uint direction) {
  return ivec3(direction >> 1 == 0u, direction >> 1 == 1u, direction >> 1 == 2u) * (int(direction & 1u) * 2 - 1);
}

uint tileWord(FieldCascade cascade, ivec3 tileLattice) { return cascade.buffers.z + tileSlot(cascade, tileLattice); }

uint findReached(ListedTile tile, FieldCascade cascade, uint direction) {
  ivec3 step = stepOf(direction), other = tile.firstTexel >> 3;
  int count = cascade.window.w >> 3;
  for (int away = 1; away < count; ++away) {
    other += step;
    if (!isInWindow(cascade, other * int(FIELD_TILE))) break;
    if (isReachedTile(tiles[tileWord(cascade, other)])) return uint(away) << 3 | direction;
  }
  return FIELD_NONE;
}

// The sign at the side that looks here: in the middle, and on the axis what is nearest. What has no candidate there is
// nearer to the coarse texel nearest to a surface than to any surface.
bool isInsideAt(FieldCascade cascade, ivec3 tileLattice, ivec3 step) {
  ivec3 firstCoarse = tileLattice * COARSE_TILE;
  float texels = coarseValue(cascade, firstCoarse + clamp(ivec3(2) - step * 2, ivec3(0), ivec3(COARSE_TILE - 1)));
  if (texels == UNKNOWN_TEXELS) {
    uint nearest = tiles[tileWord(cascade, tileLattice)].nearestTexel;
    texels = coarseValue(cascade, firstCoarse + cubeIndex(int(nearest), COARSE_TILE));
  }
  return texels < 0.0;
}

void listFlipped(uint listed) {
  uint place = atomicAdd(flippedCount, 1u);
  flipped[place] = listed;
  atomicMax(groupsX, min(place + 1u, MOST_GROUPS));
  atomicMax(groupsY, place / MOST_GROUPS + 1u);
  groupsZ = 1u;
}

// By the first thread of a tile, after the others have looked.
void decide(ListedTile tile, FieldCascade cascade, uint listed) {
  uint nearest = FIELD_NONE;
  for (uint direction = 0u; direction < 6u; ++direction)
    nearest = min(nearest, reached[gl_LocalInvocationIndex + direction]);
  bool isInside = false;
  if (nearest != FIELD_NONE) {
    ivec3 step = stepOf(nearest & 7u);
    isInside = isInsideAt(cascade, (tile.firstTexel >> 3) + step * int(nearest >> 3), step);
  }
  uint side = isInside ? FIELD_SIDE_INSIDE : FIELD_SIDE_OUTSIDE, before = sides[tile.word];
  if (side == before) return;
  sides[tile.word] = side;
  if (before != FIELD_SIDE_UNKNOWN) listFlipped(listed);
  written[atomicAdd(writtenCount, 1u)] = listed;
}

void main() {
  uint first = listIndex() * uint(TILES);
  if (first >= tileCount) return;
  if (gl_LocalInvocationIndex == 0u) writtenCount = 0u;
  uint word = first + gl_LocalInvocationIndex / uint(THREADS_OF_TILE);
  uint direction = gl_LocalInvocationIndex % uint(THREADS_OF_TILE);
  // Cascades have whole groups: the least has 8^3 tiles.
  uint cascadeIndex = field.counts.x - 1u;
  while (cascadeIndex > 0u && field.cascades[cascadeIndex].buffers.z > first) --cascadeIndex;
  FieldCascade cascade = field.cascades[cascadeIndex];
  uint listed = cascadeIndex << 24 | (word - cascade.buffers.z);
  ListedTile tile = listedTile(listed);
  bool isReached = isReachedTile(tiles[word]);
  reached[gl_LocalInvocationIndex] = isReached || direction >= 6u ? FIELD_NONE : findReached(tile, cascade, direction);
  barrier();
  if (direction == 0u && !isReached) decide(tile, cascade, listed);
  barrier();
  for (uint i = 0u; i < writtenCount; ++i) {
    ListedTile other = listedTile(written[i]);
    bool isInside = sides[other.word] == FIELD_SIDE_INSIDE;
    for (uint texel = gl_LocalInvocationIndex; texel < FIELD_TILE_TEXELS; texel += gl_WorkGroupSize.x)
      store(other.cascade, other.firstTexel + cubeIndex(int(texel), int(FIELD_TILE)), isInside ? -1e9 : 1e9,
            isInside ? FIELD_NODE_INSIDE : 0u);
  }
}
