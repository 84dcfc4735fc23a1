// Where field_objects could not tell how far objects are: each thread searches for the nearest surface points of those
// that are listed for a texel. Each bit is a function of the tile alone.
#include "lib/field_object_join.glsl"

layout(local_size_x = 512) in;

layout(std430, binding = kFieldSearchBinding) buffer SearchBlock { FieldSearch searches[]; };
layout(std430, binding = kFieldOpenBinding) readonly buffer OpenBlock {
  uint searchCount, openCount;
  uvec2 open[];
};

// returns the value, metres; much where the object is no nearer than `most`
float searchedMetres(FieldObject object, FieldObjectRow row, vec3 point, float most) {
  vec3 pointGrid = gridPoint(object, point), at = clampToBox(object.instance, pointGrid);
  BrickReading reading = readObject(object, at);
  ObjectDistance found = boundOf(object, pointGrid, reading);
  if (found.side > 0.0 && found.lower >= most) return 1e30;
  SurfacePoint surface = surfaceFrom(reading);
  if (isExact(object, found, reading)) {
    found.upper = abs(reading.grid) * object.instance.boxMax.w;
    found.surfaceGrid = pointGrid - found.side * max(abs(reading.grid), 1e-3) * surface.normalGrid;
    return signedDistance(object, found) - thinMetres(object, found);
  }
  vec3 start = surface.pointGrid, corner = nearestCorner(row, pointGrid);
  found.upper = 1e30;
  // What is nearest in the grid need not be in the world: there all corners of its cell are asked.
  int starts = !object.isSimilar ? 9 : 2;
  for (int i = 0; i < starts; ++i) {
    if (i > 0) start = object.isSimilar ? corner : cornerPoint(row, pointGrid, i - 1);
    searchSurface(object, found, start, MOST_ROUNDS, false);
  }
  return signedDistance(object, found) - thinMetres(object, found);
}

void searchTexel(uint row) {
  FieldSearch search = searches[row];
  if (search.texel == FIELD_NONE) return;
  Place place = placeOfTile(search.texel / FIELD_TILE_TEXELS);
  uint texel = search.texel % FIELD_TILE_TEXELS, word = nodes[search.texel];
  vec3 point = pointOf(place, texel);
  float metres = search.metres;
  for (;;) {
    FieldObject object = objectAt(place, search.object);
    float value = searchedMetres(object, objectRows[search.object], point, metres);
    if (isNearer(place, object, value, metres, word)) {
      metres = value;
      word = wordOf(object, word);
    }
    if (search.more == FIELD_NONE) break;
    search = searches[search.more];
  }
  searches[row].metres = metres;
  searches[row].more = word;
}

void main() {
  uint end = min(searchCount, uint(searches.length()));
  for (uint row = gl_GlobalInvocationID.x; row < end; row += gl_NumWorkGroups.x * gl_WorkGroupSize.x) searchTexel(row);
}
