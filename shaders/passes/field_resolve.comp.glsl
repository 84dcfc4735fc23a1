// The meshes' values: second round in the band (each texel's nearest of what its neighbours found), sign, clamp, store.
//
// Signs: within four texels of a surface by the pseudonormal of what is nearest. Farther away the candidate may not
// quite be the nearest and its pseudonormal point anywhere; but the ball around the texel up to the surface holds no
// other surface, so a texel three texels before the surface, on the way to the candidate, has the same sign. Tiles that
// no surface reaches have the sign of the first one along an axis that one does.
// Stage 0: texels near surfaces; 1: the others that a surface reaches; 2: the rest.
#include "lib/field_band.glsl"
#include "lib/field_candidates.glsl"
#include "lib/field_grid.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldIdBinding) readonly buffer IdBlock { uint ids[]; };
layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(std430, binding = kFieldTileBinding) readonly buffer TileBlock { FieldTile tiles[]; };
layout(binding = 0, r16f) uniform writeonly image3D distances[MOST_CASCADES];

uniform uint listLength;
uniform int stage;

const int APRON = int(FIELD_TILE) + 2;
const uint NEAR = 0x40000000u; // of a node's word: the texel was resolved by stage 0 and may be asked for its sign
const float NEAR_TEXELS = 4.5;
// Half a texel's diagonal and the error of what is asked still leave it a near one.
const float SIGN_FROM_TEXELS = 2.5;
// Farther away than this, candidates name a triangle that may lie up to a texel behind the nearest; a ray must not step
// through it, so as much is taken off (tests/oracle/world_field/exact_field_test.cpp). Inside it errs to the safe side.
const float SURE_TEXELS = 4.0, FAR_SLACK_TEXELS = 1.2;

shared uint apron[APRON * APRON * APRON];

ivec3 cubeIndex(int index, int side) { return ivec3(index % side, index / side % side, index / (side * side)); }

void gatherApron(FieldCascade cascade, ivec3 firstTexel) {
  for (int i = int(gl_LocalInvocationIndex); i < APRON * APRON * APRON; i += 128) {
    ivec3 lattice = firstTexel - 1 + cubeIndex(i, APRON);
    apron[i] = isInWindow(cascade, lattice) ? ids[texelWord(cascade, lattice)] : FIELD_NONE;
  }
}

void store(uint cascadeIndex, ivec3 lattice, float texels, uint node, uint flags) {
  FieldCascade cascade = field.cascades[cascadeIndex];
  float range = cascade.texel.z;
  uint named = abs(texels) < range ? node : 0u;
  texels = clamp(texels, -range, range);
  if ((cascade.buffers.w & FIELD_WHOLE) == 0u) { // what lies beyond the border is not known here
    ivec3 inWindow = lattice - cascade.window.xyz, toEnd = cascade.window.w - 1 - inWindow;
    ivec3 nearestSide = min(inWindow, toEnd);
    float toBorder = float(min(nearestSide.x, min(nearestSide.y, nearestSide.z))) + 0.5;
    if (texels > toBorder) named = 0u;
    texels = min(texels, toBorder);
  }
  nodes[texelWord(cascade, lattice)] = named | flags;
  imageStore(distances[cascadeIndex], lattice & (cascade.window.w - 1), vec4(texels));
}

// What the texel and its 26 neighbours found, the nearest of it.
Nearest nearestAround(ivec3 at, vec3 point, float sheetHalf) {
  int own = ((at.z + 1) * APRON + at.y + 1) * APRON + at.x + 1;
  Nearest nearest = Nearest(FIELD_NONE, 1e30);
  consider(apron[own], point, sheetHalf, nearest);
  for (int n = 0; n < 27; ++n)
    consider(apron[own + ((n / 9 - 1) * APRON + n / 3 % 3 - 1) * APRON + n % 3 - 1], point, sheetHalf, nearest);
  return nearest;
}

// sheetHalf  texels that the value lies below the distance
float sureTexels(float texels, float sheetHalf) {
  return max(min(texels, SURE_TEXELS - sheetHalf), texels - FAR_SLACK_TEXELS);
}

uint nodeOf(uint triangle) { return (triangles[triangle].codes.w >> WORLD_TRIANGLE_NODE_SHIFT) + 1u; }

void resolveNear(ListedTile tile, FieldCascade cascade) {
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (int i = int(gl_LocalInvocationIndex); i < int(FIELD_TILE_TEXELS); i += 128) {
    ivec3 at = cubeIndex(i, int(FIELD_TILE)), lattice = tile.firstTexel + at;
    vec3 point = texelCenter(cascade, lattice);
    Nearest nearest = nearestAround(at, point, sheetHalf);
    if (nearest.rank > NEAR_TEXELS * cascade.texel.x) {
      nodes[texelWord(cascade, lattice)] = 0u;
      continue;
    }
    float metres = signedTriangleDistance(triangles[nearest.triangle], point, sheetHalf);
    bool isClosed = (triangles[nearest.triangle].codes.w & WORLD_TRIANGLE_CLOSED) != 0u;
    store(tile.cascade, lattice, sureTexels(metres * cascade.texel.y, isClosed ? 0.0 : cascade.texel.w),
          nodeOf(nearest.triangle), NEAR | (isClosed && metres < 0.0 ? FIELD_NODE_INSIDE : 0u));
  }
}

bool isInsideFar(ListedTile tile, FieldCascade cascade, uint triangle, vec3 point, TriangleHit hit) {
  vec3 asked = mix(hit.closest, point, SIGN_FROM_TEXELS * cascade.texel.x * inversesqrt(hit.squared));
  ivec3 lattice = ivec3(floor(asked * cascade.texel.y));
  if (isBandTile(tiles[cascade.buffers.z + tileSlot(cascade, lattice >> 3)])) {
    uint answer = nodes[texelWord(cascade, lattice)];
    if ((answer & NEAR) != 0u) return (answer & FIELD_NODE_INSIDE) != 0u;
  }
  return signedTriangleDistance(triangles[triangle], point, 0.0) < 0.0;
}

void resolveFar(ListedTile tile, FieldCascade cascade) {
  bool isBand = isBandTile(tiles[tile.word]);
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (int i = int(gl_LocalInvocationIndex); i < int(FIELD_TILE_TEXELS); i += 128) {
    ivec3 at = cubeIndex(i, int(FIELD_TILE)), lattice = tile.firstTexel + at;
    if (isBand && (nodes[texelWord(cascade, lattice)] & NEAR) != 0u) continue;
    vec3 point = texelCenter(cascade, lattice);
    uint triangle = nearestAround(at, point, sheetHalf).triangle;
    if (triangle == FIELD_NONE) continue; // stage 2
    WorldTriangle t = triangles[triangle];
    TriangleHit hit = closestOnTriangle(point, t.a.xyz, t.b.xyz, t.c.xyz);
    bool isInside = isInsideFar(tile, cascade, triangle, point, hit);
    float sheetTexels = (t.codes.w & WORLD_TRIANGLE_CLOSED) != 0u ? 0.0 : cascade.texel.w;
    float texels = sqrt(hit.squared) * cascade.texel.y - sheetTexels;
    store(tile.cascade, lattice, isInside ? -texels : sureTexels(texels, sheetTexels), nodeOf(triangle),
          isInside ? FIELD_NODE_INSIDE : 0u);
  }
}

// Texels of a reached tile that have no candidate themselves: nearer to those that have one than to any surface.
void resolveBeyond(ListedTile tile, FieldCascade cascade) {
  ivec3 known = tile.firstTexel + cubeIndex(int(tiles[tile.word].nearestTexel), COARSE_TILE) * COARSE;
  uint inside = nodes[texelWord(cascade, known)] & FIELD_NODE_INSIDE;
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (int i = int(gl_LocalInvocationIndex); i < int(FIELD_TILE_TEXELS); i += 128) {
    ivec3 at = cubeIndex(i, int(FIELD_TILE)), lattice = tile.firstTexel + at;
    if (nearestAround(at, texelCenter(cascade, lattice), sheetHalf).triangle == FIELD_NONE)
      store(tile.cascade, lattice, inside != 0u ? -1e9 : 1e9, 0u, inside);
  }
}

// A texel of the nearest tile along an axis that is reached, at the side that looks here.
bool askAlong(ListedTile tile, FieldCascade cascade, ivec3 step, out bool isInside) {
  isInside = false;
  ivec3 tileLattice = tile.firstTexel >> 3;
  int count = cascade.window.w >> 3;
  for (int i = 1; i < count; ++i) {
    ivec3 other = tileLattice + step * i;
    if (!isInWindow(cascade, other * int(FIELD_TILE))) return false;
    if (!isReachedTile(tiles[cascade.buffers.z + tileSlot(cascade, other)])) continue;
    ivec3 side = ivec3(4) - step * 4 + min(step, ivec3(0)); // the middle, on the axis the side that looks here
    isInside = (nodes[texelWord(cascade, other * int(FIELD_TILE) + clamp(side, ivec3(0), ivec3(7)))] & FIELD_NODE_INSIDE) != 0u;
    return true;
  }
  return false;
}

void resolveUnreached(ListedTile tile, FieldCascade cascade) {
  bool isInside = false;
  for (int i = 0; i < 6; ++i) {
    ivec3 step = ivec3(i >> 1 == 0, i >> 1 == 1, i >> 1 == 2) * ((i & 1) * 2 - 1);
    if (askAlong(tile, cascade, step, isInside)) break;
  }
  for (int i = int(gl_LocalInvocationIndex); i < int(FIELD_TILE_TEXELS); i += 128)
    store(tile.cascade, tile.firstTexel + cubeIndex(i, int(FIELD_TILE)), isInside ? -1e9 : 1e9, 0u,
          isInside ? FIELD_NODE_INSIDE : 0u);
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  bool isReached = isReachedTile(tiles[tile.word]);
  if (stage == 0) {
    if (!isBandTile(tiles[tile.word])) return;
    gatherApron(cascade, tile.firstTexel);
    barrier();
    resolveNear(tile, cascade);
  } else if (stage == 1) {
    if (!isReached) return;
    gatherApron(cascade, tile.firstTexel);
    barrier();
    resolveFar(tile, cascade);
  } else if (isReached) {
    gatherApron(cascade, tile.firstTexel);
    barrier();
    resolveBeyond(tile, cascade);
  } else {
    resolveUnreached(tile, cascade);
  }
}
