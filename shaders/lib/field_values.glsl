// How the values of meshes are stored: clamped to the range and to what a window can know, with their nodes.
#include "lib/field_band.glsl"
#include "lib/field_candidates.glsl"
#include "lib/field_grid.glsl"

layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(std430, binding = kFieldTileBinding) readonly buffer TileBlock { FieldTile tiles[]; };
layout(binding = 0, r16f) uniform writeonly image3D distances[MOST_CASCADES];

// Of a node's word: the texel was evaluated at full resolution; is so near that others may ask it for its sign; and
// that sign was turned after they had asked, to whom it remains what it was: they may ask while it is being turned.
const uint FINE = 0x40000000u, SIGNED = 0x20000000u, TURNED = 0x10000000u;
const float SIGNED_TEXELS = 3.5; // rank
// Farther away than this, candidates name a triangle that may lie up to a texel behind the nearest, and values lie
// between those of coarse texels; a ray must not step through, so as much is taken off outside
// (tests/oracle/world_field/exact_field_test.cpp).
const float SURE_TEXELS = 4.0, FAR_SLACK_TEXELS = 1.8;

bool isBandAt(FieldCascade cascade, ivec3 lattice) {
  return isBandTile(tiles[cascade.buffers.z + tileSlot(cascade, lattice >> 3)]);
}

// at  texelWord of the texel
void storeAt(uint at, uint cascadeIndex, ivec3 lattice, float texels, uint word) {
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
  nodes[at] = word;
  imageStore(distances[cascadeIndex], lattice & (cascade.window.w - 1), vec4(texels));
}

void store(uint cascadeIndex, ivec3 lattice, float texels, uint word) {
  storeAt(texelWord(field.cascades[cascadeIndex], lattice), cascadeIndex, lattice, texels, word);
}

// sheetHalf  texels that the value lies below the distance
float sureTexels(float texels, float sheetHalf) {
  return max(min(texels, SURE_TEXELS - sheetHalf), texels - FAR_SLACK_TEXELS);
}

uint nodeOf(WorldTriangle t) { return (t.codes.w >> WORLD_TRIANGLE_NODE_SHIFT) + 1u; }
bool isClosed(WorldTriangle t) { return (t.codes.w & WORLD_TRIANGLE_CLOSED) != 0u; }

// The value of a texel whose nearest triangle is known for sure.
//
// signedMetres  as signedTriangleDistance
void storeFine(uint cascadeIndex, ivec3 lattice, WorldTriangle t, float signedMetres, float thin) {
  FieldCascade cascade = field.cascades[cascadeIndex];
  float texels = signedMetres * cascade.texel.y;
  bool closed = isClosed(t);
  bool isInside = closed && texels < 0.0;
  bool isSigned = abs(texels) + cascade.texel.w <= SIGNED_TEXELS;
  store(cascadeIndex, lattice, (isInside ? texels : sureTexels(texels, closed ? 0.0 : cascade.texel.w)) - thin,
        nodeOf(t) | FINE | (isSigned ? SIGNED : 0u) | (isInside ? FIELD_NODE_INSIDE : 0u));
}
