// Makes the grid of nearest surface points around a field. In the first round each grid point searches by itself; then
// each takes the nearest of what it and its 26 neighbours found, and searches on from there.
#include "lib/field_grid.glsl"
#include "lib/field_objects.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kNearestPointBinding) readonly buffer BeforeBlock { vec4 before[]; }; // grid space; w: distance
layout(std430, binding = kNearestPointBinding + 1) writeonly buffer AfterBlock { vec4 after[]; };
layout(binding = 0, rgba16) uniform writeonly image3D stored;

uniform vec3 boxMin, boxMax; // of the field, its grid space
uniform ivec2 levels;        // first row, and how many
uniform ivec3 firstTexel;    // of its block
uniform vec3 firstPoint, cell; // of the grid
uniform bool isFirst, isLast;

const int SIDE = int(NEAREST_POINTS);
const int FIRST_ROUNDS = 8, NEXT_ROUNDS = 3;

FieldObject fieldItself(float texelVoxels) {
  vec4 rows[3] = vec4[3](vec4(1.0, 0.0, 0.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0), vec4(0.0, 0.0, 1.0, 0.0));
  SdfInstance instance =
      SdfInstance(rows, rows, vec4(boxMin, 1.0), vec4(boxMax, 1.0), ivec4(0, levels.x, levels.y, 0));
  return fieldObject(instance, vec3(0.0), texelVoxels);
}

vec4 nearestAround(ivec3 at, vec3 point) {
  vec4 nearest = vec4(0.0);
  float least = 1e30;
  for (int i = 0; i < 27; ++i) {
    ivec3 other = at + cubeIndex(i, 3) - 1;
    if (any(lessThan(other, ivec3(0))) || any(greaterThanEqual(other, ivec3(SIDE)))) continue;
    vec4 found = before[(other.z * SIDE + other.y) * SIDE + other.x];
    float away = other == at ? found.w : distance(found.xyz, point);
    if (away >= least) continue;
    least = away;
    nearest = found;
  }
  return vec4(nearest.xyz, least);
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= SIDE * SIDE * SIDE) return;
  ivec3 at = cubeIndex(index, SIDE);
  vec3 point = firstPoint + vec3(at) * cell;
  FieldObject object = fieldItself(min(cell.x, min(cell.y, cell.z)));
  BrickReading reading = readObject(object, clampToBox(object.instance, point));
  ObjectDistance found = boundOf(object, point, reading);
  vec3 start;
  found.upper = 1e30;
  if (isFirst) {
    start = surfaceFrom(reading).pointGrid;
  } else {
    vec4 nearest = nearestAround(at, point);
    start = nearest.xyz;
    found.upper = nearest.w;
  }
  found.surfaceGrid = start;
  searchSurface(object, found, start, isFirst ? FIRST_ROUNDS : NEXT_ROUNDS, isFirst);
  after[index] = vec4(found.surfaceGrid, found.upper);
  if (!isLast) return;
  vec3 part = (found.surfaceGrid - boxMin) / (boxMax - boxMin);
  imageStore(stored, firstTexel + at, vec4(part, 0.5 + 0.5 * found.side * found.upper / length(float(SIDE - 1) * cell)));
}
