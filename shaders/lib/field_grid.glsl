// Where texels, coarse texels and tiles of the world field lie: see shared/world_field_params.h for the spaces.
#include "shared/bindings.h"
#include "shared/world_field_params.h"

layout(std140, binding = kFieldUniformBinding) uniform FieldBlock { FieldParams field; };

const int COARSE = 2;      // texels of a coarse one, along a side
const int COARSE_TILE = 4; // coarse texels of a tile, along a side
const uint COARSE_TILE_TEXELS = 64u;

uint tileSlot(FieldCascade cascade, ivec3 tileLattice) {
  int tiles = cascade.window.w >> 3;
  ivec3 slot = tileLattice & (tiles - 1);
  return uint((slot.z * tiles + slot.y) * tiles + slot.x);
}

bool isInWindow(FieldCascade cascade, ivec3 lattice) {
  ivec3 inWindow = lattice - cascade.window.xyz;
  return all(greaterThanEqual(inWindow, ivec3(0))) && all(lessThan(inWindow, cascade.window.www));
}

uint indexInTile(ivec3 lattice, int side) {
  ivec3 at = lattice & (side - 1);
  return uint((at.z * side + at.y) * side + at.x);
}

// The index-th place of a cube, x fastest.
ivec3 cubeIndex(int index, int side) { return ivec3(index % side, index / side % side, index / (side * side)); }

// What a coordinate along each axis adds to texelWord.
uvec3 texelWordParts(FieldCascade cascade, ivec3 lattice) {
  int tiles = cascade.window.w >> 3;
  uvec3 slot = uvec3(lattice >> 3 & tiles - 1), at = uvec3(lattice & 7);
  return (slot * FIELD_TILE_TEXELS) * uvec3(1, tiles, tiles * tiles) + at * uvec3(1, 8, 64);
}

// Word of a texel in the buffers that hold one word a texel.
uint texelWord(FieldCascade cascade, ivec3 lattice) {
  return cascade.buffers.x + tileSlot(cascade, lattice >> 3) * FIELD_TILE_TEXELS + indexInTile(lattice, int(FIELD_TILE));
}

// The same of a coarse texel; coarse lattice = lattice / 2.
uint coarseWord(FieldCascade cascade, ivec3 coarse) {
  return cascade.buffers.y + tileSlot(cascade, coarse >> 2) * COARSE_TILE_TEXELS + indexInTile(coarse, COARSE_TILE);
}

// Word, in the buffer of candidates, that holds the distances of a coarse texel and its neighbour along x as halves:
// they follow the candidates of all cascades.
uint coarseDistanceWord(uint coarse) { return field.coarse.x + coarse / 2u; }

// Places of a cube of ten texels around a tile that do not lie in it: 488 of them.
const int TILE_RIM = 488;
ivec3 rimPlace(int index) {
  if (index < 200) {
    int z = index < 100 ? 0 : 9, inPlane = index < 100 ? index : index - 100;
    return ivec3(inPlane % 10, inPlane / 10, z);
  }
  int z = (index - 200) / 36, inRing = (index - 200) % 36;
  int x = inRing < 20 ? inRing % 10 : (inRing & 1) * 9;
  int y = inRing < 20 ? inRing / 10 * 9 : (inRing - 20 >> 1) + 1;
  return ivec3(x, y, z + 1);
}

struct ListedTile {
  uint cascade;
  uint word;        // in the buffer of tiles
  ivec3 firstTexel; // lattice
};

ListedTile listedTile(uint listed) {
  uint slot = listed & 0xffffffu;
  FieldCascade cascade = field.cascades[listed >> 24];
  int tiles = cascade.window.w >> 3, bits = findMSB(tiles); // a power of two
  ivec3 at = ivec3(slot, slot >> bits, slot >> 2 * bits) & (tiles - 1);
  ivec3 firstTile = cascade.window.xyz >> 3;
  ivec3 tileLattice = firstTile + ((at - firstTile) & (tiles - 1));
  return ListedTile(listed >> 24, cascade.buffers.z + slot, tileLattice * int(FIELD_TILE));
}

vec3 texelCenter(FieldCascade cascade, ivec3 lattice) { return (vec3(lattice) + 0.5) * cascade.texel.x; }
vec3 coarseCenter(FieldCascade cascade, ivec3 coarse) { return (vec3(coarse) + 0.5) * (2.0 * cascade.texel.x); }

// Work groups of a long list, which one dimension cannot number.
uint listIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
