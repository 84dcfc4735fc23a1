// SDF objects join the field: the minimum of the meshes' value and the values of all objects that reach a tile. Each texel
// asks the grids of nearest points which objects may be nearest, then reads their bricks; what needs a search for the
// nearest surface point is listed for field_objects_search.
#include "shared/world_field_params.h"

layout(local_size_x = FIELD_TILE_TEXELS) in; // a texel each

#include "lib/field_object_tile.glsl"

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
layout(std430, binding = kFieldSearchBinding) buffer SearchBlock { FieldSearch searches[]; };
layout(std430, binding = kFieldOpenBinding) buffer OpenBlock {
  uint searchCount, openCount;
  uvec2 open[]; // of each tile with searches their first row, and how many
};

shared uint ownSearches, firstSearch; // of the group

// A value so far.
struct Joined {
  float metres;
  uint word;
  FieldSearch search; // object FIELD_NONE: none
  float least;        // that its object's value may be
};

void join(Place place, FieldObject object, float value, inout Joined joined) {
  if (!isNearer(place, object, value, joined.metres, joined.word)) return;
  joined.metres = value;
  joined.word = wordOf(object, joined.word);
}

vec3 gridPointOf(FieldObjectRow row, vec3 point) {
  vec3 p = point - vec3(row.gridFromAnchored[0].w, row.gridFromAnchored[1].w, row.gridFromAnchored[2].w);
  return vec3(dot(row.gridFromAnchored[0].xyz, p), dot(row.gridFromAnchored[1].xyz, p), dot(row.gridFromAnchored[2].xyz, p));
}

// The least that an object's value may be, by what needs none of its bricks.
//
// most  metres beyond which no object counts; comes back as what this one cannot exceed
float leastValue(Place place, FieldObjectRow row, vec3 point, inout float most) {
  vec3 pointGrid = gridPointOf(row, point), inBox = clamp(pointGrid, row.boxMin.xyz, row.boxMax.xyz);
  float metres = row.boxMax.w, outer = metres * distance(pointGrid, inBox);
  if (outer > 0.0 && outer > most) return outer;
  if (!isTold(place, row)) return pointGrid == inBox ? -1e30 : outer;
  NearPoint near = nearPoint(row, pointGrid);
  // A distance changes no faster than the way to the grid points.
  most = min(most, metres * (near.signedGrid + 0.9 * row.points.w + near.outer));
  return metres * leastOf(near);
}

// A voxel before a surface point, where distances are finest.
vec3 beforeSurface(FieldObject object, vec3 pointGrid, vec3 surfaceGrid) {
  vec3 way = pointGrid - surfaceGrid;
  return clampToBox(object.instance, surfaceGrid + way * min(1.0, object.fineVoxel / max(length(way), 1e-6)));
}

// Metres to a point outside by way of a place that was read.
float upperBy(FieldObject object, vec3 pointGrid, vec3 at, BrickReading reading) {
  if ((reading.cell & CELL_EMPTY) != 0u) return 1e30;
  bool isFar = reading.voxel > object.fineVoxel || abs(reading.grid) > 1.5 * reading.voxel;
  float inner = reading.grid + (isFar ? KINK_VOXELS * reading.voxel : 0.0);
  return object.instance.boxMax.w * (distance(pointGrid, at) + inner);
}

// The least that a value may be which is to be searched for, metres.
float leastSearched(FieldObject object, ObjectDistance bound, BrickReading reading) {
  if (bound.side > 0.0) return bound.lower;
  float deepest = object.instance.boxMax.w * (abs(reading.grid) + KINK_VOXELS * reading.voxel);
  return (reading.cell & CELL_EMPTY) != 0u ? -1e30 : -deepest;
}

// Lists an object to be searched.
//
// least   metres
// returns false where there is no row left
bool listSearch(uint number, float least, inout Joined joined) {
  if (joined.search.object == FIELD_NONE || joined.least >= joined.metres) {
    joined.search.object = number;
    joined.least = least;
    return true;
  }
  uint row = atomicAdd(searchCount, 1u);
  if (row >= uint(searches.length())) return false;
  searches[row] = FieldSearch(FIELD_NONE, number, joined.search.more, least);
  joined.search.more = row;
  return true;
}

// Lets an object join, or lists it to be searched. One loop, and one place in it that reads: first the distance, then
// behind what is found.
void joinObject(Place place, uint number, vec3 point, inout Joined joined) {
  FieldObject object = objectAt(place, number);
  float metres = object.instance.boxMax.w, texel = object.texelMetres, told = 0.0;
  vec3 pointGrid = gridPoint(object, point), at = clampToBox(object.instance, pointGrid);
  bool isAround = isTold(place, objectRows[number]) && pointGrid != at;
  ObjectDistance bound;
  if (isAround) {
    NearPoint near = nearPoint(objectRows[number], pointGrid);
    float least = metres * leastOf(near);
    bound = ObjectDistance(pointGrid, 1.0, least, least, near.surfaceGrid);
    told = metres * near.signedGrid + AGREED_TEXELS * texel;
    if (isInBand(object, bound)) at = beforeSurface(object, pointGrid, near.surfaceGrid);
  }
  float thin = 0.0;
  bool isBehind = false, isKnown = isAround && !isInBand(object, bound);
  while (!isKnown) {
    BrickReading reading = readObject(object, at);
    if (isBehind) {
      thin = thinBehind(object, bound, at, reading);
      break;
    }
    if (isAround) {
      bound.upper = upperBy(object, pointGrid, at, reading);
      isKnown = bound.upper < told;
    } else {
      bound = boundOf(object, pointGrid, reading);
      isKnown = isExact(object, bound, reading);
      if (isKnown) bound.upper = abs(reading.grid) * metres;
      if (!isInBand(object, bound)) break;
    }
    bool isNear = bound.upper < FADED_TEXELS * texel;
    if (!isKnown || (isNear && !isAround)) { // in the box the way to the surface is not known
      if (listSearch(number, leastSearched(object, bound, reading), joined)) return;
      bound.upper = bound.lower; // what is known from below joins: no ray steps through
      break;
    }
    if (!isNear || !placeBehind(object, bound, at)) break;
    isKnown = false;
    isBehind = true;
  }
  join(place, object, signedDistance(object, bound) - thin, joined);
}

// Of the objects listed the three that may be nearest, of those after another.
const int CHOSEN = 3;
struct Choice {
  float least[CHOSEN];
  uint at[CHOSEN]; // in the list
};

void choose(float least, uint at, inout Choice choice) {
  for (int i = 0; i < CHOSEN; ++i) {
    bool isBefore = least < choice.least[i] || (least == choice.least[i] && at < choice.at[i]);
    float otherLeast = choice.least[i];
    uint otherAt = choice.at[i];
    choice.least[i] = isBefore ? least : otherLeast;
    choice.at[i] = isBefore ? at : otherAt;
    least = isBefore ? otherLeast : least;
    at = isBefore ? otherAt : at;
  }
}

void joinListed(Place place, vec3 point, inout Joined joined) {
  float lastLeast = -2e30;
  uint lastAt = 0u;
  for (;;) {
    Choice choice;
    for (int i = 0; i < CHOSEN; ++i) choice.least[i] = 1e30, choice.at[i] = 0u;
    float most = joined.metres;
    for (uint i = 0u; i < reachingCount; ++i) {
      uvec2 it = nearestFirst[i];
      if (most > 0.0 && uintBitsToFloat(it.x) > most) break;
      float least = leastValue(place, objectRows[it.y], point, most);
      bool isAfter = least > lastLeast || (least == lastLeast && i > lastAt);
      if (isAfter && least < most) choose(least, i, choice);
    }
    for (int i = 0; i < CHOSEN; ++i) {
      if (choice.least[i] >= joined.metres) return;
      joinObject(place, nearestFirst[choice.at[i]].y, point, joined);
    }
    lastLeast = choice.least[CHOSEN - 1];
    lastAt = choice.at[CHOSEN - 1];
  }
}

// Threads of a warp have a block of 4x4x2 texels, which ask the same objects.
uint texelOfThread(uint thread) {
  uint x = (thread & 3u) | (thread >> 5 & 1u) << 2, y = (thread >> 2 & 3u) | (thread >> 6 & 1u) << 2;
  return x | y << 3 | (thread >> 4 & 1u) << 6 | (thread >> 7 & 3u) << 7;
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  Place place = placeOf(listed[index]);
  uint texel = texelOfThread(gl_LocalInvocationIndex), nodeAt = texelWord(place.cascade, latticeOf(place, texel));
  if (gl_LocalInvocationIndex == 0u) farthestBits = 0u, ownSearches = 0u;
  barrier();
  vec3 point = pointOf(place, texel);
  float before = storedMetres(place, texel);
  Joined joined;
  joined.metres = before;
  joined.word = nodes[nodeAt];
  joined.search = FieldSearch(nodeAt, FIELD_NONE, FIELD_NONE, 0.0);
  joined.least = 0.0;
  uint wordBefore = joined.word;
  atomicMax(farthestBits, floatBitsToUint(max(before, 0.0))); // positive floats are ordered as their bits
  barrier();
  for (uint first = 0u; first < field.counts.z;) {
    first = listObjects(place, first, uintBitsToFloat(farthestBits));
    joinListed(place, point, joined);
    barrier();
  }
  bool isOpen = joined.search.object != FIELD_NONE &&
                (joined.search.more != FIELD_NONE || joined.least < joined.metres);
  uint rank = isOpen ? atomicAdd(ownSearches, 1u) : 0u;
  barrier();
  if (gl_LocalInvocationIndex == 0u && ownSearches > 0u) {
    firstSearch = atomicAdd(searchCount, ownSearches);
    open[atomicAdd(openCount, 1u)] = uvec2(firstSearch, ownSearches);
  }
  barrier();
  uint row = firstSearch + rank;
  if (isOpen && row < uint(searches.length())) {
    joined.search.metres = joined.metres;
    searches[row] = joined.search;
  } else if (isOpen) {
    FieldSearch lost = joined.search;
    lost.metres = joined.least;
    for (;;) {
      join(place, objectAt(place, lost.object), lost.metres, joined);
      if (lost.more == FIELD_NONE) break;
      lost = searches[lost.more];
    }
  }
  if (joined.metres == before && joined.word == wordBefore) return;
  nodes[nodeAt] = joined.word;
  imageStore(distances[place.tile.cascade], latticeOf(place, texel) & (place.cascade.window.w - 1),
             vec4(joined.metres * place.cascade.texel.y));
}
