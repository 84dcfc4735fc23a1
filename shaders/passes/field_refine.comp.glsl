// The band at full resolution, second round: each texel without a key takes the nearest of what it and its six
// neighbours found.
#include "lib/field_band.glsl"
#include "lib/field_open.glsl"
#include "lib/field_values.glsl"

layout(local_size_x = OPEN_THREADS) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldIdBinding) readonly buffer IdBlock { uint ids[]; };
layout(std430, binding = kFieldTileBinding) readonly buffer TileBlock { FieldTile tiles[]; };

uniform uint listLength;
uniform bool isKept; // the tiles' nearest triangles stand from an earlier update, and all their values are made again

const int APRON = int(FIELD_TILE) + 2;
shared uint apron[APRON * APRON * APRON];
bool isBandAt(FieldCascade cascade, ivec3 lattice) {
  return isBandTile(tiles[cascade.buffers.z + tileSlot(cascade, lattice >> 3)]);
}

// Of a texel of the tile.
int apronIndex(int texel) {
  ivec3 at = cubeIndex(texel, int(FIELD_TILE)) + 1;
  return (at.z * APRON + at.y) * APRON + at.x;
}

void load(ListedTile tile, FieldCascade cascade) {
  if (gl_LocalInvocationIndex == 0u) openCount = 0u;
  for (int i = int(gl_LocalInvocationIndex); i < APRON * APRON * APRON; i += int(OPEN_THREADS)) {
    ivec3 at = cubeIndex(i, APRON) - 1, lattice = tile.firstTexel + at;
    bool isKnown = ivec3(at & 7) == at || (isInWindow(cascade, lattice) && isBandAt(cascade, lattice));
    apron[i] = isKnown ? ids[texelWord(cascade, lattice)] : FIELD_NONE;
  }
  barrier();
  uint mine = 0u;
  for (int k = 0; k < OWN_TEXELS; ++k) {
    uint id = apron[apronIndex(k * int(OPEN_THREADS) + int(gl_LocalInvocationIndex))];
    if (isKept ? id != FIELD_NONE : (id & FIELD_ID_FINAL) == 0u) mine |= 1u << k;
  }
  listOpen(mine);
  barrier();
}

// To the neighbour beyond the face-th face, 0 to 5.
int faceStep(int face) {
  int step = face < 2 ? 1 : face < 4 ? APRON : APRON * APRON;
  return (face & 1) == 0 ? -step : step;
}

void considerAt(int at, vec3 point, float sheetHalf, inout Nearest nearest) {
  if (apron[at] != FIELD_NONE) consider(apron[at] & ~FIELD_ID_FINAL, point, sheetHalf, nearest);
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  if (!isBandTile(tiles[tile.word])) return;
  load(tile, cascade);
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (uint i = gl_LocalInvocationIndex; i < openCount; i += OPEN_THREADS) {
    int own = apronIndex(int(open[i]));
    ivec3 lattice = tile.firstTexel + cubeIndex(int(open[i]), int(FIELD_TILE));
    vec3 point = texelCenter(cascade, lattice);
    Nearest nearest = Nearest(FIELD_NONE, 1e30);
    // The texel itself, then its neighbours along the axes.
    int count = (apron[own] & FIELD_ID_FINAL) == 0u ? 7 : 1;
    for (int n = 0; n < count; ++n) considerAt(own + (n == 0 ? 0 : faceStep(n - 1)), point, sheetHalf, nearest);
    if (nearest.rank > FINE_TEXELS * cascade.texel.x)
      nodes[texelWord(cascade, lattice)] = 0u;
    else
      storeFine(tile.cascade, lattice, triangles[nearest.triangle], point, sheetHalf);
  }
}
