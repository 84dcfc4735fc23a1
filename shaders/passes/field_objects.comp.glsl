// SDF objects join the field: the minimum of the meshes' value and the values of all objects that reach a tile.
// Every texel asks all objects for bounds. Texels that need more search for a surface point of the object that is nearest
// by its bound; then, where the bound of another stays below what was found, of that; at last once more from what their
// neighbours found. Each bit is a function of the tile alone.
#include "lib/field_grid.glsl"
#include "lib/field_objects.glsl"

layout(local_size_x = FIELD_TILE_TEXELS) in; // a texel each

#ifdef FLIPPED // the tiles that field_sides turned over
layout(std430, binding = kFieldFlipBinding) readonly buffer FlipBlock {
  uint groupsX, groupsY, groupsZ;
  uint listLength;
  uint listed[];
};
#else
layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
uniform uint listLength;
#endif
layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(std430, binding = kFieldSphereBinding) readonly buffer SphereBlock { vec4 spheres[]; };
layout(binding = 0, r16f) uniform image3D distances[MOST_CASCADES];

// Of one round: objects are asked as many at a time as there are threads while all of them would have room. No more, as
// 32 KiB of shared memory are promised.
const uint MOST_REACHING = FIELD_TILE_TEXELS + 96u;
const float INSIDE_FIRST = -1e30;
const uint NO_OBJECT = 0xffffffffu, OBJECT_MASK = 0x7fffffffu, OBJECT_UNSURE = 0x80000000u;

shared uvec2 reaching[MOST_REACHING]; // distance from the tile, float bits; number
shared uvec2 nearestFirst[MOST_REACHING];
shared uint reachingCount;
shared uint farthestBits; // largest value in the tile, metres
// Of each texel: the value so far, metres, and the node's word.
shared float nearestMetres[FIELD_TILE_TEXELS];
shared uint nearestWord[FIELD_TILE_TEXELS];
// The object whose search was the last, and its bound; the bound of the one that is next.
shared uint lastObject[FIELD_TILE_TEXELS];
shared float lastBound[FIELD_TILE_TEXELS];
shared float nextBound[FIELD_TILE_TEXELS];
// The object that was found nearest, whether another of its points may be nearer, a surface point of it in its grid, and
// how far away that is.
shared uint foundObject[FIELD_TILE_TEXELS];
shared vec4 surfacePoints[FIELD_TILE_TEXELS];
shared uint open[FIELD_TILE_TEXELS]; // texels that are to search; their order does not matter
shared uint openCount;

struct Place {
  FieldCascade cascade;
  ListedTile tile;
  vec3 tileCenter;    // anchored
  float halfDiagonal; // between centres of texels
};

ivec3 latticeOf(Place place, uint texel) { return place.tile.firstTexel + cubeIndex(int(texel), int(FIELD_TILE)); }

vec3 pointOf(Place place, uint texel) { return texelCenter(place.cascade, latticeOf(place, texel)); }

float storedMetres(Place place, uint texel) {
  ivec3 slot = latticeOf(place, texel) & (place.cascade.window.w - 1);
  return imageLoad(distances[place.tile.cascade], slot).r * place.cascade.texel.x;
}

FieldObject objectAt(Place place, uint number) {
  return fieldObject(sdfInstances[number], field.anchor.xyz, place.cascade.texel.x);
}

// Lists those of the next objects that may be nearer than `most` to a texel of the tile, or around it.
// returns the first that was not asked
uint listObjects(Place place, uint first, float most) {
  if (gl_LocalInvocationIndex == 0u) reachingCount = 0u;
  barrier();
  while (first < field.counts.z && reachingCount + FIELD_TILE_TEXELS <= MOST_REACHING) {
    barrier(); // all have read the count
    uint number = first + gl_LocalInvocationIndex;
    float reach = most + place.halfDiagonal;
    if (number < field.counts.z) {
      vec4 sphere = spheres[number];
      if (distance(sphere.xyz, place.tileCenter) - sphere.w < reach) {
        float least = max(boxDistance(objectAt(place, number), place.tileCenter) - place.halfDiagonal, 0.0);
        if (least <= most) reaching[atomicAdd(reachingCount, 1u)] = uvec2(floatBitsToUint(least), number);
      }
    }
    barrier();
    first += FIELD_TILE_TEXELS;
  }
  barrier();
  for (uint own = gl_LocalInvocationIndex; own < reachingCount; own += FIELD_TILE_TEXELS) {
    uint rank = 0u;
    uvec2 it = reaching[own];
    for (uint i = 0u; i < reachingCount; ++i) {
      uvec2 other = reaching[i];
      rank += uint(other.x < it.x || (other.x == it.x && other.y < it.y));
    }
    nearestFirst[rank] = it;
  }
  barrier();
  return first;
}

// returns whether it is the nearest so far
bool join(Place place, FieldObject object, uint texel, float value) {
  float range = place.cascade.texel.z * place.cascade.texel.x, metres = nearestMetres[texel];
  uint word = nearestWord[texel], node = uint(object.instance.ids.x) + 1u;
  value = max(value, -range);
  if (value > metres || (value == metres && (value >= range || node >= (word & FIELD_NODE_MASK)))) return false;
  nearestMetres[texel] = value;
  nearestWord[texel] = node | (word & ~FIELD_NODE_MASK); // what it says of meshes stays: updates to come ask for it
  return true;
}

// An object to be searched, those around the texel first, then by the bound.
struct Candidate {
  uint object; // NO_OBJECT: there is none
  float bound;
  float next; // of the one after it
};

bool isBefore(float bound, uint object, Candidate other) {
  return bound < other.bound || (bound == other.bound && object < other.object);
}

// The candidate after another. Objects that need no search join.
Candidate nextCandidate(Place place, uint texel, Candidate last) {
  vec3 point = pointOf(place, texel);
  Candidate best = Candidate(NO_OBJECT, 1e30, 1e30);
  for (uint r = 0u; r < reachingCount; ++r) {
    uvec2 near = nearestFirst[r];
    float metres = nearestMetres[texel];
    if (metres > 0.0 && uintBitsToFloat(near.x) > metres) break;
    FieldObject object = objectAt(place, near.y);
    if (metres > 0.0 && boxDistance(object, point) > metres) continue;
    BrickReading reading = readObject(object, clampToBox(object.instance, gridPoint(object, point)));
    ObjectDistance bound = boundOf(object, gridPoint(object, point), reading);
    if (bound.side > 0.0 && bound.lower >= metres) continue;
    bool isKnown = isExact(object, bound, reading);
    if (isKnown) bound.upper = abs(reading.grid) * object.instance.boxMax.w;
    if (!isInBand(object, bound) || (isKnown && bound.upper >= FADED_TEXELS * object.texelMetres)) {
      join(place, object, texel, signedDistance(object, bound));
      continue;
    }
    float key = bound.side < 0.0 ? INSIDE_FIRST : bound.lower;
    if (!isBefore(last.bound, last.object, Candidate(near.y, key, 0.0))) continue;
    if (isBefore(key, near.y, best)) best = Candidate(near.y, key, best.bound);
    else best.next = min(best.next, key);
  }
  if (best.bound >= nearestMetres[texel]) best.object = NO_OBJECT;
  return best;
}

// For the thread's texel; lists it if it is to search.
void chooseObject(Place place) {
  uint texel = gl_LocalInvocationIndex;
  if (nextBound[texel] >= nearestMetres[texel]) return;
  Candidate candidate = nextCandidate(place, texel, Candidate(lastObject[texel], lastBound[texel], 0.0));
  nextBound[texel] = candidate.next;
  if (candidate.object == NO_OBJECT) return;
  lastObject[texel] = candidate.object;
  lastBound[texel] = candidate.bound;
  open[atomicAdd(openCount, 1u)] = texel;
}

// The surface point of that neighbour in the tile whose is nearest, where it is nearer than the own one: between two
// surfaces, and around corners, not every texel finds the right one. Inside an object its own surface alone counts.
// returns its object's number, NO_OBJECT if none is nearer
uint nearerNeighbour(Place place, uint texel, out vec3 surface) {
  vec3 point = pointOf(place, texel);
  float least = surfacePoints[texel].w - 2.0 * ACCURATE_TEXELS * place.cascade.texel.x;
  uint nearer = NO_OBJECT;
  ivec3 at = cubeIndex(int(texel), int(FIELD_TILE));
  for (int side = 0; side < 6; ++side) {
    ivec3 beside = at + ivec3(side >> 1 == 0, side >> 1 == 1, side >> 1 == 2) * ((side & 1) * 2 - 1);
    if (any(lessThan(beside, ivec3(0))) || any(greaterThanEqual(beside, ivec3(FIELD_TILE)))) continue;
    uint other = indexInTile(beside, int(FIELD_TILE)), number = foundObject[other];
    if (number == NO_OBJECT) continue;
    number &= OBJECT_MASK;
    if (nearestMetres[texel] < 0.0 && number != (foundObject[texel] & OBJECT_MASK)) continue;
    vec3 otherSurface = surfacePoints[other].xyz;
    FieldObject object = objectAt(place, number);
    float away = lengthWorld(object.instance, gridPoint(object, point) - otherSurface);
    if (away >= least) continue;
    least = away;
    nearer = number;
    surface = otherSurface;
  }
  return nearer;
}

// For a listed texel.
void searchObject(Place place, uint texel) {
  uint number = lastObject[texel];
  FieldObject object = objectAt(place, number);
  vec3 pointGrid = gridPoint(object, pointOf(place, texel));
  BrickReading reading = readObject(object, clampToBox(object.instance, pointGrid));
  ObjectDistance found = boundOf(object, pointGrid, reading);
  SurfacePoint surface = surfaceFrom(reading);
  if (isExact(object, found, reading)) {
    found.upper = abs(reading.grid) * object.instance.boxMax.w;
    found.surfaceGrid = pointGrid - found.side * max(abs(reading.grid), 1e-3) * surface.normalGrid;
  } else {
    found.upper = 1e30;
    searchSurface(object, found, surface.pointGrid, MOST_ROUNDS, true);
  }
  bool isNearest = join(place, object, texel, signedDistance(object, found) - thinMetres(object, found));
  if (!isNearest && foundObject[texel] != NO_OBJECT) return;
  bool isSure = found.upper - found.lower < 2.0 * ACCURATE_TEXELS * object.texelMetres;
  foundObject[texel] = number | (isSure ? 0u : OBJECT_UNSURE);
  surfacePoints[texel] = vec4(found.surfaceGrid, found.upper);
}

// Once more from a neighbour's surface point. Inside an object what was found may have been too deep.
void searchAgain(Place place, uint texel) {
  vec3 surface;
  uint number = nearerNeighbour(place, texel, surface);
  if (number == NO_OBJECT) return;
  FieldObject object = objectAt(place, number);
  vec3 pointGrid = gridPoint(object, pointOf(place, texel));
  ObjectDistance found = boundOf(object, pointGrid, readObject(object, clampToBox(object.instance, pointGrid)));
  bool isSame = (foundObject[texel] & OBJECT_MASK) == number;
  if (nearestMetres[texel] < 0.0) {
    if (uint(object.instance.ids.x) + 1u != (nearestWord[texel] & FIELD_NODE_MASK)) return; // a mesh is deeper
    nearestMetres[texel] = storedMetres(place, texel);
  }
  found.upper = isSame ? surfacePoints[texel].w : 1e30;
  if (isSame) found.surfaceGrid = surfacePoints[texel].xyz;
  searchSurface(object, found, surface, MOST_ROUNDS_FROM_NEIGHBOUR, false);
  join(place, object, texel, signedDistance(object, found) - thinMetres(object, found));
}

void emptyOpen() {
  barrier();
  if (gl_LocalInvocationIndex == 0u) openCount = 0u;
  barrier();
}

void joinListed(Place place) {
  uint own = gl_LocalInvocationIndex;
  lastObject[own] = 0u;
  lastBound[own] = -2e30;
  nextBound[own] = -2e30;
  foundObject[own] = NO_OBJECT;
  do {
    emptyOpen();
    chooseObject(place);
    barrier();
    if (own < openCount) searchObject(place, open[own]);
    barrier();
  } while (openCount > 0u);
  emptyOpen();
  if (foundObject[own] != NO_OBJECT && (foundObject[own] & OBJECT_UNSURE) != 0u) open[atomicAdd(openCount, 1u)] = own;
  barrier();
  if (own < openCount) searchAgain(place, open[own]);
  barrier();
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  float texelMetres = cascade.texel.x;
  Place place = Place(cascade, tile, (vec3(tile.firstTexel) + 0.5 * float(FIELD_TILE)) * texelMetres,
                      0.8660255 * float(FIELD_TILE - 1u) * texelMetres);
  if (gl_LocalInvocationIndex == 0u) farthestBits = 0u;
  barrier();
  uint texel = gl_LocalInvocationIndex, nodeAt = texelWord(cascade, latticeOf(place, texel)), wordBefore = nodes[nodeAt];
  float before = storedMetres(place, texel);
  nearestMetres[texel] = before;
  nearestWord[texel] = wordBefore;
  atomicMax(farthestBits, floatBitsToUint(max(before, 0.0))); // positive floats are ordered as their bits
  barrier();
  for (uint first = 0u; first < field.counts.z;) {
    first = listObjects(place, first, uintBitsToFloat(farthestBits));
    joinListed(place);
  }
  if (nearestMetres[texel] == before && nearestWord[texel] == wordBefore) return;
  nodes[nodeAt] = nearestWord[texel];
  imageStore(distances[tile.cascade], latticeOf(place, texel) & (cascade.window.w - 1),
             vec4(nearestMetres[texel] * cascade.texel.y));
}
