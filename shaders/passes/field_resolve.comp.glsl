// The meshes' values: near surfaces a second round at full resolution (each texel's nearest of what its neighbours
// found), farther away between the coarse candidates; signs; clamp; store.
//
// Signs: within four texels of a surface by the pseudonormal of what is nearest. Farther away the candidate may not
// quite be the nearest and its pseudonormal point anywhere; but the ball around the texel up to the surface holds no
// other surface, so a texel before the surface, on the way to the candidate, has the same sign. Tiles that no surface
// reaches have the sign of the first one along an axis that one does.
// Stage 0: texels near surfaces; 1: the others of tiles that a surface reaches; 2: the other tiles.
#include "lib/field_band.glsl"
#include "lib/field_candidates.glsl"
#include "lib/field_grid.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldIdBinding) readonly buffer IdBlock { uint ids[]; };
layout(std430, binding = kFieldCandidateBinding) readonly buffer CandidateBlock { uint candidates[]; };
layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(std430, binding = kFieldTileBinding) readonly buffer TileBlock { FieldTile tiles[]; };
layout(binding = 0, r16f) uniform writeonly image3D distances[MOST_CASCADES];

uniform uint listLength;
uniform int stage;

const int APRON = int(FIELD_TILE) + 2, COARSE_APRON = COARSE_TILE + 2;
// Of a node's word: the texel was resolved by stage 0; and is so near that its neighbours may ask it for its sign.
const uint FINE = 0x40000000u, SIGNED = 0x20000000u;
// Ranks, which are half a texel more than the distance from closed surfaces.
const float FINE_TEXELS = 5.0, SIGNED_TEXELS = 3.5;
// How far before a surface its sign is asked for: half a texel's diagonal to and fro stays within SIGNED_TEXELS.
const float SIGN_FROM_TEXELS = 2.0;
// Farther away than this, candidates name a triangle that may lie up to a texel behind the nearest, and values lie
// between those of coarse texels; a ray must not step through, so as much is taken off outside
// (tests/oracle/world_field/exact_field_test.cpp).
const float SURE_TEXELS = 4.0, FAR_SLACK_TEXELS = 1.6;

shared uint apron[APRON * APRON * APRON];
shared float coarseTexels[COARSE_APRON * COARSE_APRON * COARSE_APRON];
shared uint coarseWords[COARSE_APRON * COARSE_APRON * COARSE_APRON]; // as of nodes

bool isBandAt(FieldCascade cascade, ivec3 lattice) {
  return isBandTile(tiles[cascade.buffers.z + tileSlot(cascade, lattice >> 3)]);
}

void store(uint cascadeIndex, ivec3 lattice, float texels, uint word) {
  FieldCascade cascade = field.cascades[cascadeIndex];
  float range = cascade.texel.z;
  if (abs(texels) >= range) word &= ~FIELD_NODE_MASK;
  texels = clamp(texels, -range, range);
  if ((cascade.buffers.w & FIELD_WHOLE) == 0u) { // what lies beyond the border is not known here
    ivec3 inWindow = lattice - cascade.window.xyz, toEnd = cascade.window.w - 1 - inWindow;
    ivec3 nearestSide = min(inWindow, toEnd);
    float toBorder = float(min(nearestSide.x, min(nearestSide.y, nearestSide.z))) + 0.5;
    if (texels > toBorder) word &= ~FIELD_NODE_MASK;
    texels = min(texels, toBorder);
  }
  nodes[texelWord(cascade, lattice)] = word;
  imageStore(distances[cascadeIndex], lattice & (cascade.window.w - 1), vec4(texels));
}

// sheetHalf  texels that the value lies below the distance
float sureTexels(float texels, float sheetHalf) {
  return max(min(texels, SURE_TEXELS - sheetHalf), texels - FAR_SLACK_TEXELS);
}

uint nodeOf(uint triangle) { return (triangles[triangle].codes.w >> WORLD_TRIANGLE_NODE_SHIFT) + 1u; }
bool isClosed(uint triangle) { return (triangles[triangle].codes.w & WORLD_TRIANGLE_CLOSED) != 0u; }

void resolveNear(ListedTile tile, FieldCascade cascade) {
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (int i = int(gl_LocalInvocationIndex); i < APRON * APRON * APRON; i += 128) {
    ivec3 lattice = tile.firstTexel - 1 + cubeIndex(i, APRON);
    bool isKnown = isInWindow(cascade, lattice) && isBandAt(cascade, lattice);
    apron[i] = isKnown ? ids[texelWord(cascade, lattice)] : FIELD_NONE;
  }
  barrier();
  for (int i = int(gl_LocalInvocationIndex); i < int(FIELD_TILE_TEXELS); i += 128) {
    ivec3 at = cubeIndex(i, int(FIELD_TILE)), lattice = tile.firstTexel + at;
    vec3 point = texelCenter(cascade, lattice);
    int own = ((at.z + 1) * APRON + at.y + 1) * APRON + at.x + 1;
    Nearest nearest = Nearest(FIELD_NONE, 1e30);
    consider(apron[own], point, sheetHalf, nearest);
    consider(apron[own - 1], point, sheetHalf, nearest);
    consider(apron[own + 1], point, sheetHalf, nearest);
    consider(apron[own - APRON], point, sheetHalf, nearest);
    consider(apron[own + APRON], point, sheetHalf, nearest);
    consider(apron[own - APRON * APRON], point, sheetHalf, nearest);
    consider(apron[own + APRON * APRON], point, sheetHalf, nearest);
    if (nearest.rank > FINE_TEXELS * cascade.texel.x) {
      nodes[texelWord(cascade, lattice)] = 0u;
      continue;
    }
    float texels = signedTriangleDistance(triangles[nearest.triangle], point, sheetHalf) * cascade.texel.y;
    bool closed = isClosed(nearest.triangle);
    bool isInside = closed && texels < 0.0;
    store(tile.cascade, lattice, isInside ? texels : sureTexels(texels, closed ? 0.0 : cascade.texel.w),
          nodeOf(nearest.triangle) | FINE | (nearest.rank <= SIGNED_TEXELS * cascade.texel.x ? SIGNED : 0u) |
              (isInside ? FIELD_NODE_INSIDE : 0u));
  }
}

bool isInsideFar(FieldCascade cascade, WorldTriangle t, vec3 point, TriangleHit hit) {
  float share = SIGN_FROM_TEXELS * cascade.texel.x * inversesqrt(hit.squared);
  ivec3 lattice = ivec3(floor(mix(hit.closest, point, min(share, 1.0)) * cascade.texel.y));
  bool isSure = share > SIGN_FROM_TEXELS; // nearer than a texel
  if (!isSure && isBandAt(cascade, lattice)) {
    uint answer = nodes[texelWord(cascade, lattice)];
    if ((answer & SIGNED) != 0u) return (answer & FIELD_NODE_INSIDE) != 0u;
  }
  return signedTriangleDistance(t, point, 0.0) < 0.0;
}

// Signed values of the coarse texels in and around the tile; beyond reach there is no word and the sign is left open.
void evaluateCoarse(ListedTile tile, FieldCascade cascade) {
  for (int i = int(gl_LocalInvocationIndex); i < COARSE_APRON * COARSE_APRON * COARSE_APRON; i += 128) {
    ivec3 coarse = tile.firstTexel / COARSE - 1 + cubeIndex(i, COARSE_APRON);
    // Beyond the window's border stand the candidates of the border.
    ivec3 first = cascade.window.xyz / COARSE;
    uint triangle = candidates[coarseWord(cascade, clamp(coarse, first, first + cascade.window.w / COARSE - 1))];
    coarseTexels[i] = cascade.texel.z;
    coarseWords[i] = 0u;
    if (triangle == FIELD_NONE) continue;
    WorldTriangle t = triangles[triangle];
    vec3 point = coarseCenter(cascade, coarse);
    TriangleHit hit = closestOnTriangle(point, t.a.xyz, t.b.xyz, t.c.xyz);
    bool isInside = isInsideFar(cascade, t, point, hit);
    float sheetTexels = (t.codes.w & WORLD_TRIANGLE_CLOSED) != 0u ? 0.0 : cascade.texel.w;
    float texels = sqrt(hit.squared) * cascade.texel.y - sheetTexels;
    coarseTexels[i] = isInside ? -texels : sureTexels(texels, sheetTexels);
    coarseWords[i] = ((t.codes.w >> WORLD_TRIANGLE_NODE_SHIFT) + 1u) | (isInside ? FIELD_NODE_INSIDE : 0u);
  }
}

// A fine texel whose sign is better asked for than its own.
void reviseSign(uint cascadeIndex, FieldCascade cascade, ivec3 lattice) {
  uint word = nodes[texelWord(cascade, lattice)], triangle = ids[texelWord(cascade, lattice)];
  if ((word & SIGNED) != 0u || !isClosed(triangle)) return;
  WorldTriangle t = triangles[triangle];
  vec3 point = texelCenter(cascade, lattice);
  TriangleHit hit = closestOnTriangle(point, t.a.xyz, t.b.xyz, t.c.xyz);
  bool isInside = isInsideFar(cascade, t, point, hit);
  if (isInside == ((word & FIELD_NODE_INSIDE) != 0u)) return;
  float texels = sqrt(hit.squared) * cascade.texel.y;
  store(cascadeIndex, lattice, isInside ? -texels : sureTexels(texels, 0.0), word ^ FIELD_NODE_INSIDE);
}

int coarseIndex(ivec3 c) { return (c.z * COARSE_APRON + c.y) * COARSE_APRON + c.x; }

void resolveFar(ListedTile tile, FieldCascade cascade) {
  bool isBand = isBandTile(tiles[tile.word]);
  evaluateCoarse(tile, cascade);
  barrier();
  // What has no candidate is nearer to a coarse texel that has one than to any surface: it has its sign.
  uint known = coarseWords[coarseIndex(cubeIndex(int(tiles[tile.word].nearestTexel), COARSE_TILE) + 1)];
  float side = (known & FIELD_NODE_INSIDE) != 0u ? -1.0 : 1.0;
  for (int i = int(gl_LocalInvocationIndex); i < int(FIELD_TILE_TEXELS); i += 128) {
    ivec3 at = cubeIndex(i, int(FIELD_TILE)), lattice = tile.firstTexel + at;
    if (isBand && (nodes[texelWord(cascade, lattice)] & FINE) != 0u) {
      reviseSign(tile.cascade, cascade, lattice);
      continue;
    }
    ivec3 lowest = (at + 1) >> 1;           // of the eight around it, in the apron
    vec3 part = mix(vec3(0.75), vec3(0.25), vec3(at & 1)); // of the upper ones: centres lie at quarters
    float texels = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      ivec3 step = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      int c = coarseIndex(lowest + step);
      vec3 weights = mix(1.0 - part, part, vec3(step));
      texels += weights.x * weights.y * weights.z * (coarseWords[c] == 0u ? side * coarseTexels[c] : coarseTexels[c]);
    }
    uint word = coarseWords[coarseIndex((at >> 1) + 1)];
    store(tile.cascade, lattice, texels, word == 0u ? known & FIELD_NODE_INSIDE : word);
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
    ivec3 side = clamp(ivec3(4) - step * 4, ivec3(0), ivec3(7)); // the middle, on the axis the side that looks here
    isInside = (nodes[texelWord(cascade, other * int(FIELD_TILE) + side)] & FIELD_NODE_INSIDE) != 0u;
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
    store(tile.cascade, tile.firstTexel + cubeIndex(i, int(FIELD_TILE)), isInside ? -1e9 : 1e9,
          isInside ? FIELD_NODE_INSIDE : 0u);
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  if (stage == 0) {
    if (isBandTile(tiles[tile.word])) resolveNear(tile, cascade);
  } else if (isReachedTile(tiles[tile.word]) != (stage == 1)) {
    return;
  } else if (stage == 1) {
    resolveFar(tile, cascade);
  } else {
    resolveUnreached(tile, cascade);
  }
}
