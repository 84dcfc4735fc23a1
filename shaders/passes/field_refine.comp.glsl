// The band at full resolution, second round: each texel without a key takes the nearest of what it and its six
// neighbours found; then all get their values.
#include "lib/field_keys.glsl"
#include "lib/field_open.glsl"
#include "lib/field_values.glsl"

layout(local_size_x = OPEN_THREADS) in;

#ifdef LISTED // all tiles of a list that are of the band, not those alone whose candidates are new
layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
uniform uint listLength;
#else
layout(std430, binding = kFieldBandBinding) readonly buffer BandBlock {
  uint bandCount;
  uint band[]; // words as those of lists, in whatever order
};
#endif
layout(std430, binding = kFieldKeyBinding) readonly buffer KeyBlock { uint keys[]; };

const int APRON = int(FIELD_TILE) + 2, RIM_ROUNDS = (TILE_RIM + int(OPEN_THREADS) - 1) / int(OPEN_THREADS);
shared uint apron[APRON * APRON * APRON];
shared bool isKnown[27]; // of the tile and those around it: whether field_evaluate went over them

// Of a texel of the tile.
int apronIndex(int texel) {
  ivec3 at = cubeIndex(texel, int(FIELD_TILE)) + 1;
  return (at.z * APRON + at.y) * APRON + at.x;
}

// Reads of one kind stand together: they are waited for once, those in a loop one after the other.
void load(ListedTile tile, FieldCascade cascade) {
  if (gl_LocalInvocationIndex == 0u) openCount = 0u;
  uint own[OWN_TEXELS];
  for (int k = 0; k < OWN_TEXELS; ++k)
    own[k] = keys[tile.word * FIELD_TILE_TEXELS + uint(k) * OPEN_THREADS + gl_LocalInvocationIndex];
  if (gl_LocalInvocationIndex < 27u) {
    ivec3 lattice = tile.firstTexel + (cubeIndex(int(gl_LocalInvocationIndex), 3) - 1) * int(FIELD_TILE);
    isKnown[gl_LocalInvocationIndex] = isInWindow(cascade, lattice) && isBandAt(cascade, lattice);
  }
  barrier();
  uint rim[RIM_ROUNDS];
  int rimPlaces[RIM_ROUNDS];
  for (int k = 0; k < RIM_ROUNDS; ++k) {
    ivec3 place = rimPlace(min(k * int(OPEN_THREADS) + int(gl_LocalInvocationIndex), TILE_RIM - 1));
    ivec3 at = place - 1, inTiles = (at >> 3) + 1;
    bool isHere = isKnown[(inTiles.z * 3 + inTiles.y) * 3 + inTiles.x];
    rimPlaces[k] = (place.z * APRON + place.y) * APRON + place.x;
    rim[k] = isHere ? keys[texelWord(cascade, tile.firstTexel + at)] : FIELD_NONE;
  }
  uint mine = 0u;
  for (int k = 0; k < OWN_TEXELS; ++k) {
    uint texel = uint(k) * OPEN_THREADS + gl_LocalInvocationIndex;
    apron[apronIndex(int(texel))] = own[k];
    if (own[k] != FIELD_NONE)
      mine |= 1u << k;
    else // nothing is known of it here
      nodes[tile.word * FIELD_TILE_TEXELS + texel] = 0u;
  }
  for (int k = 0; k < RIM_ROUNDS; ++k) apron[rimPlaces[k]] = rim[k];
  listOpen(mine);
  barrier();
}

void considerAt(int at, vec3 point, float sheetHalf, inout Nearest nearest) {
  consider(triangleOfWord(apron[at]), point, sheetHalf, nearest);
}

// Closed parts thinner than a texel count as a texel thick, else rays slip through between texels: what is to be taken
// off. A texel behind the nearest place, seen from outside, lies beyond such a part, by as much as the part is thinner
// than a texel; each of its sides gives half. One to two texels away the rule fades.
//
// outwards  pseudonormal at the nearest place of a closed part
float thinTexels(FieldCascade cascade, vec3 point, TriangleHit hit, vec3 outwards) {
  float texels = sqrt(hit.squared) * cascade.texel.y, share = 2.0 - texels;
  if (share <= 0.0) return 0.0;
  vec3 away = point - hit.closest;
  bool isInside = dot(away, outwards) < 0.0;
  if (isInside && texels > 0.5) return 0.0; // of a part that is thick enough
  bool isOn = hit.squared * cascade.texel.y * cascade.texel.y < 1e-4;
  vec3 direction = unitOrZero(isOn ? outwards : isInside ? -away : away);
  vec3 behind = hit.closest - direction * cascade.texel.x;
  ivec3 lattice = ivec3(floor(behind * cascade.texel.y));
  if (!isInWindow(cascade, lattice) || !isBandAt(cascade, lattice)) return 0.0;
  uint triangle = triangleOfWord(keys[texelWord(cascade, lattice)]);
  if (triangle == FIELD_NONE) return 0.0;
  WorldTriangle back = triangles[triangle];
  if (!isClosed(back)) return 0.0;
  TriangleHit backHit = closestOnTriangle(behind, back.a.xyz, back.b.xyz, back.c.xyz);
  vec3 beyond = behind - backHit.closest, backOutwards = unitOrZero(pseudonormalOf(back, backHit, beyond));
  bool isBack = dot(beyond, backOutwards) > 0.0 && dot(backOutwards, direction) < -0.3;
  return isBack ? 0.5 * min(share, 1.0) * min(length(beyond) * cascade.texel.y, 1.0) : 0.0;
}

void storeNearest(uint cascadeIndex, ivec3 lattice, vec3 point, Nearest nearest) {
  FieldCascade cascade = field.cascades[cascadeIndex];
  WorldTriangle t = triangles[nearest.triangle];
  if (!isClosed(t)) {
    storeFine(cascadeIndex, lattice, t, nearest.rank - cascade.texel.w * cascade.texel.x, 0.0);
    return;
  }
  TriangleHit hit = closestOnTriangle(point, t.a.xyz, t.b.xyz, t.c.xyz);
  vec3 away = point - hit.closest, outwards = pseudonormalOf(t, hit, away);
  float metres = sqrt(hit.squared);
  storeFine(cascadeIndex, lattice, t, dot(away, outwards) < 0.0 ? -metres : metres,
            thinTexels(cascade, point, hit, outwards));
}

void refineTile(ListedTile tile) {
  FieldCascade cascade = field.cascades[tile.cascade];
  load(tile, cascade);
  float sheetHalf = cascade.texel.w * cascade.texel.x;
  for (uint i = gl_LocalInvocationIndex; i < openCount; i += OPEN_THREADS) {
    int own = apronIndex(int(open[i]));
    ivec3 lattice = tile.firstTexel + cubeIndex(int(open[i]), int(FIELD_TILE));
    vec3 point = texelCenter(cascade, lattice);
    Nearest nearest = Nearest(FIELD_NONE, 1e30);
    // The texel itself, then its neighbours along the axes.
    considerAt(own, point, sheetHalf, nearest);
    bool isKeyed = isKey(apron[own]);
    for (int step = 1; step < APRON * APRON * APRON && !isKeyed; step *= APRON) {
      considerAt(own - step, point, sheetHalf, nearest);
      considerAt(own + step, point, sheetHalf, nearest);
    }
    if (nearest.rank > KEPT_TEXELS * cascade.texel.x)
      nodes[texelWord(cascade, lattice)] = 0u;
    else
      storeNearest(tile.cascade, lattice, point, nearest);
  }
}

void main() {
#ifdef LISTED
  if (listIndex() >= listLength) return;
  ListedTile tile = listedTile(listed[listIndex()]);
  if (isBandTile(tiles[tile.word])) refineTile(tile);
#else
  for (uint at = gl_WorkGroupID.x; at < bandCount; at += gl_NumWorkGroups.x) {
    refineTile(listedTile(band[at]));
    barrier();
  }
#endif
}
