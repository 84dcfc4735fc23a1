// What the band's rounds left, in tiles that a surface reaches: values between the coarse ones. Fine texels whose own sign
// is not sure ask for it. Other tiles are left to field_sides.
//
// Where closed parts, or folds of one, reach into each other, a surface that lies buried shows its outside to what is
// inside, and signs contradict each other: opposite ones lie closer together than any surface. There what one texel of
// several sees from behind is inside for all.
#include "lib/field_far.glsl"
#include "lib/field_keys.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldKeyBinding) readonly buffer KeyBlock { uint keys[]; };
layout(std430, binding = kFieldCandidateBinding) readonly buffer CandidateBlock { uint candidates[]; };

uniform uint listLength;

#include "lib/field_coarse_values.glsl"

const int APRON = COARSE_TILE + 2;
shared float coarseTexels[APRON * APRON * APRON];
shared uint coarseNodes[COARSE_TILE_TEXELS];
shared uint unsure[FIELD_TILE_TEXELS]; // texels to be asked for their sign together, or'ed with TOLD
shared uint unsureCount;
shared bool isTorn; // signs of the tile contradict each other
shared bool hasSide[2]; // any coarse texel is outside, inside

// Coarse neighbours lie two texels apart. Of opposite signs their distances sum to no more, and what candidates err by.
const float TORN_TEXELS = 2.0 + 0.8;
const uint TOLD = 0x8000u;
// From a texel to the farthest of the eight coarse ones around it, 1.5 along each axis, and the same.
const float TOLD_TEXELS = 2.5980762 + 0.6;

// The k-th of two that a thread has of the apron's places; the last is had by several.
int placeOf(int k) { return min(int(gl_LocalInvocationIndex) + 128 * k, APRON * APRON * APRON - 1); }

void load(ListedTile tile, FieldCascade cascade, float unknown) {
  if (gl_LocalInvocationIndex == 0u) unsureCount = 0u, isTorn = hasSide[0] = hasSide[1] = false;
  barrier();
  ivec3 firstCoarse = tile.firstTexel / COARSE, first = cascade.window.xyz / COARSE;
  // Both reads stand together: they are waited for once.
  float texels[2];
  for (int k = 0; k < 2; ++k) {
    // Beyond the window's border stand the values of the border.
    ivec3 coarse = firstCoarse - 1 + cubeIndex(placeOf(k), APRON);
    texels[k] = coarseValue(cascade, clamp(coarse, first, first + cascade.window.w / COARSE - 1));
  }
  for (int k = 0; k < 2; ++k) {
    if (texels[k] == UNKNOWN_TEXELS) texels[k] = unknown;
    coarseTexels[placeOf(k)] = texels[k];
    hasSide[texels[k] < 0.0 ? 1 : 0] = true;
  }
  if (gl_LocalInvocationIndex < COARSE_TILE_TEXELS) {
    uint triangle = candidates[coarseWord(cascade, firstCoarse) + gl_LocalInvocationIndex];
    coarseNodes[gl_LocalInvocationIndex] = triangle == FIELD_NONE ? 0u : nodeOf(triangles[triangle]);
  }
  barrier();
}

// After load.
void findTears() {
  if (!hasSide[0] || !hasSide[1]) return;
  for (int i = int(gl_LocalInvocationIndex); i < APRON * APRON * APRON; i += 128) {
    ivec3 at = cubeIndex(i, APRON);
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] == APRON - 1) continue;
      float own = coarseTexels[i], other = coarseTexels[i + (axis == 0 ? 1 : axis == 1 ? APRON : APRON * APRON)];
      if (own * other < 0.0 && abs(own - other) > TORN_TEXELS) isTorn = true;
    }
  }
  barrier();
}

// The eight coarse texels around a texel of the tile.
struct Around {
  vec4 low, high; // in x; in the order of y, z
};

Around around(ivec3 at) {
  ivec3 lowest = (at + 1) >> 1; // of the eight, in the apron
  int c = (lowest.z * APRON + lowest.y) * APRON + lowest.x;
  const int Y = APRON, Z = APRON * APRON;
  int d = c + 1;
  return Around(vec4(coarseTexels[c], coarseTexels[c + Y], coarseTexels[c + Z], coarseTexels[c + Y + Z]),
                vec4(coarseTexels[d], coarseTexels[d + Y], coarseTexels[d + Z], coarseTexels[d + Y + Z]));
}

float leastOf(Around texels) {
  vec4 least = min(texels.low, texels.high);
  return min(min(least.x, least.y), min(least.z, least.w));
}

float between(ivec3 at, Around texels) {
  vec3 part = mix(vec3(0.75), vec3(0.25), vec3(at & 1)); // of the upper ones: centres lie at quarters
  vec4 alongX = mix(texels.low, texels.high, part.x);
  vec2 alongY = mix(alongX.xz, alongX.yw, part.y);
  return mix(alongY.x, alongY.y, part.z);
}

// A fine texel whose sign is better asked for than its own.
//
// at      its word
// isTold  the coarse ones around it lie so deep inside that it does as well
void reviseSign(uint at, uint cascadeIndex, FieldCascade cascade, ivec3 lattice, bool isTold) {
  uint word = nodes[at];
  WorldTriangle t = triangles[triangleOfWord(keys[at])];
  if (!isClosed(t)) return;
  vec3 point = texelCenter(cascade, lattice);
  TriangleHit hit = closestOnTriangle(point, t.a.xyz, t.b.xyz, t.c.xyz);
  bool isInside = isTold || isInsideFar(cascade, t, point, hit);
  if (isInside == ((word & FIELD_NODE_INSIDE) != 0u)) return;
  float texels = sqrt(hit.squared) * cascade.texel.y;
  storeAt(at, cascadeIndex, lattice, isInside ? -texels : sureTexels(texels, 0.0), word ^ (FIELD_NODE_INSIDE | TURNED));
}

// In a torn tile.
float betweenTorn(ivec3 at) {
  Around texels = around(at);
  // All of them lie nearer to the texel than any surface.
  if (leastOf(texels) < 0.0) texels = Around(-abs(texels.low), -abs(texels.high));
  return between(at, texels);
}

// Between the four coarse texels around a texel in a plane across z.
//
// lowest  of the four, in the apron
// part    of the upper ones
float betweenInPlane(int lowest, vec2 part) {
  return mix(mix(coarseTexels[lowest], coarseTexels[lowest + 1], part.x),
             mix(coarseTexels[lowest + APRON], coarseTexels[lowest + APRON + 1], part.x), part.y);
}

void resolveReached(ListedTile tile, FieldCascade cascade) {
  FieldTile kept = tiles[tile.word];
  bool isBand = isBandTile(kept);
  bool isInside = coarseValue(cascade, tile.firstTexel / COARSE + cubeIndex(int(kept.nearestTexel), COARSE_TILE)) < 0.0;
  // What has no candidate is farther away than that (field_candidates).
  float unknown = cascade.texel.z + 1.5;
  load(tile, cascade, isInside ? -unknown : unknown);
  findTears();
  // A thread has every other texel along z: each plane of coarse ones serves two of them.
  ivec3 at = cubeIndex(int(gl_LocalInvocationIndex), int(FIELD_TILE));
  uint word = tile.word * FIELD_TILE_TEXELS + gl_LocalInvocationIndex;
  ivec2 lowest = (at.xy + 1) >> 1;
  int plane = (at.z * APRON + lowest.y) * APRON + lowest.x;
  vec3 part = mix(vec3(0.75), vec3(0.25), vec3(at & 1)); // centres lie at quarters
  float below = betweenInPlane(plane, part.xy);
  for (; at.z < int(FIELD_TILE); at.z += 2, word += 128u) {
    plane += APRON * APRON;
    float above = betweenInPlane(plane, part.xy), texels = mix(below, above, part.z);
    below = above;
    ivec3 lattice = tile.firstTexel + at;
    uint kept = isBand ? nodes[word] : 0u;
    if ((kept & FINE) != 0u) {
      bool isTold = isTorn && leastOf(around(at)) < -TOLD_TEXELS;
      if ((kept & SIGNED) == 0u || (isTold && (kept & FIELD_NODE_INSIDE) == 0u))
        unsure[atomicAdd(unsureCount, 1u)] = word % FIELD_TILE_TEXELS | (isTold ? TOLD : 0u);
      continue;
    }
    if (isTorn) texels = betweenTorn(at);
    ivec3 coarse = at >> 1;
    uint node = coarseNodes[(coarse.z * COARSE_TILE + coarse.y) * COARSE_TILE + coarse.x];
    storeAt(word, tile.cascade, lattice, texels, node | (texels < 0.0 ? FIELD_NODE_INSIDE : 0u));
  }
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < unsureCount; i += 128u) {
    uint texel = unsure[i] % FIELD_TILE_TEXELS;
    ivec3 lattice = tile.firstTexel + cubeIndex(int(texel), int(FIELD_TILE));
    reviseSign(tile.word * FIELD_TILE_TEXELS + texel, tile.cascade, cascade, lattice, (unsure[i] & TOLD) != 0u);
  }
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  if (isReachedTile(tiles[tile.word])) resolveReached(tile, cascade);
}
