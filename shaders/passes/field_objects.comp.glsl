// SDF objects join the field: the minimum of the meshes' value and the values of all objects that reach a tile.
// Objects are taken nearest first, so that those behind are soon told to be farther; the order, and with it each bit,
// is a function of the tile alone. Texels near an object search for its surface, then again from what their neighbours
// found.
#include "lib/field_grid.glsl"
#include "lib/field_objects.glsl"

layout(local_size_x = FIELD_TILE_TEXELS) in; // a texel each

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(binding = 0, r16f) uniform image3D distances[MOST_CASCADES];

uniform uint listLength;

const uint MOST_OBJECTS = FIELD_TILE_TEXELS; // of one round
const float NO_POINT = -1.0;

shared uvec2 reaching[MOST_OBJECTS]; // distance from the tile, float bits; number
shared uint nearestFirst[MOST_OBJECTS];
shared uint reachingCount;
shared uint farthestBits;                     // largest value in the tile, metres
shared vec4 surfacePoints[FIELD_TILE_TEXELS]; // of the object at hand, grid; w: distance, metres

// Of the thread's texel.
float metres; // to the nearest so far
uint word;    // of its node
ObjectDistance found;

// Lists the objects of a round that may be nearer than `most` to a texel of the tile.
void listObjects(uint first, vec3 tileCenter, float halfDiagonal, float most) {
  uint thread = gl_LocalInvocationIndex, object = first + thread;
  if (thread == 0u) reachingCount = 0u;
  barrier();
  if (object < field.counts.z) {
    float least = max(boxDistance(sdfInstances[object], tileCenter) - halfDiagonal, 0.0);
    if (least < most) reaching[atomicAdd(reachingCount, 1u)] = uvec2(floatBitsToUint(least), object);
  }
  barrier();
  if (thread < reachingCount) {
    uvec2 own = reaching[thread];
    uint rank = 0u;
    for (uint i = 0u; i < reachingCount; ++i) {
      uvec2 other = reaching[i];
      rank += uint(other.x < own.x || (other.x == own.x && other.y < own.y));
    }
    nearestFirst[rank] = own.y;
  }
  barrier();
}

// Each texel for itself.
void findAlone(FieldObject object, vec3 point) {
  surfacePoints[gl_LocalInvocationIndex].w = NO_POINT;
  found.isSearched = false;
  found.side = 1.0;
  found.lower = found.upper = boxDistance(object.instance, point);
  if (metres > 0.0 && found.lower > metres) return;
  found = boundDistance(object, point, metres);
  if (!found.isSearched) return;
  searchSurface(object, found, found.surfaceGrid, MOST_STEPS, true);
  surfacePoints[gl_LocalInvocationIndex] = vec4(found.surfaceGrid, found.upper);
}

// Once more from the surface point of that neighbour in the tile whose is nearest, where it is nearer than the own one:
// between two surfaces, and around corners, not every texel finds the right one.
void findFromNeighbours(FieldObject object) {
  float least = found.upper - 2.0 * ACCURATE_TEXELS * object.texelMetres;
  if (!found.isSearched || least < found.lower) return;
  ivec3 at = cubeIndex(int(gl_LocalInvocationIndex), int(FIELD_TILE));
  vec3 start = vec3(0.0);
  bool isNearer = false;
  for (int side = 0; side < 6; ++side) {
    ivec3 beside = at + ivec3(side >> 1 == 0, side >> 1 == 1, side >> 1 == 2) * ((side & 1) * 2 - 1);
    if (any(lessThan(beside, ivec3(0))) || any(greaterThanEqual(beside, ivec3(FIELD_TILE)))) continue;
    vec4 other = surfacePoints[indexInTile(beside, int(FIELD_TILE))];
    float away = lengthWorld(object.instance, found.pointGrid - other.xyz);
    if (other.w == NO_POINT || away >= least) continue;
    least = away;
    start = other.xyz;
    isNearer = true;
  }
  if (isNearer) searchSurface(object, found, start, MOST_STEPS_FROM_NEIGHBOUR, false);
}

// returns whether the object is what is nearest to the texel
bool join(FieldObject object, float range) {
  uint node = uint(object.instance.ids.x) + 1u, owner = word & FIELD_NODE_MASK;
  float distance = max(signedDistance(object, found), -range);
  if (distance > metres || (distance == metres && (distance >= range || node >= owner))) return false;
  metres = distance;
  word = node | (word & ~FIELD_NODE_MASK); // what it says of meshes stays: updates to come ask for it
  return true;
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  float texelMetres = cascade.texel.x;
  ivec3 lattice = tile.firstTexel + cubeIndex(int(gl_LocalInvocationIndex), int(FIELD_TILE));
  vec3 point = field.anchor.xyz + texelCenter(cascade, lattice);
  metres = imageLoad(distances[tile.cascade], lattice & (cascade.window.w - 1)).r * texelMetres;
  word = nodes[texelWord(cascade, lattice)];
  // In rounds; objects farther than the tile's largest value can change nothing.
  vec3 tileCenter = field.anchor.xyz + (vec3(tile.firstTexel) + 0.5 * float(FIELD_TILE)) * texelMetres;
  float halfDiagonal = 0.8660255 * float(FIELD_TILE - 1u) * texelMetres;
  bool isChanged = false;
  for (uint first = 0u; first < field.counts.z; first += MOST_OBJECTS) {
    if (gl_LocalInvocationIndex == 0u) farthestBits = 0u;
    barrier();
    atomicMax(farthestBits, floatBitsToUint(max(metres, 0.0))); // positive floats are ordered as their bits
    barrier();
    listObjects(first, tileCenter, halfDiagonal, uintBitsToFloat(farthestBits));
    for (uint r = 0u; r < reachingCount; ++r) {
      FieldObject object = fieldObject(sdfInstances[nearestFirst[r]], texelMetres);
      findAlone(object, point);
      // The same for all threads.
      if (boxDistance(object.instance, tileCenter) - halfDiagonal < BAND_TEXELS * texelMetres) {
        barrier();
        findFromNeighbours(object);
        barrier();
      }
      if (join(object, cascade.texel.z * texelMetres)) isChanged = true;
    }
  }
  if (!isChanged) return;
  nodes[texelWord(cascade, lattice)] = word;
  imageStore(distances[tile.cascade], lattice & (cascade.window.w - 1), vec4(metres * cascade.texel.y));
}
