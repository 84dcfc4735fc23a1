// SDF objects in the world field: signed distances to an object from its bricks, wherever a point lies.
// Within the field's band the distance is that of a surface point that is searched for: a bound from above, which no
// step of the search lets grow. Beyond, and to tell which objects count, a bound from below.
// Grid space: voxels of the finest level; lengths in it are metres of world only where the transform is a similarity.
#include "lib/bricks.glsl"

// Level voxels up to which no corner that weighs in a stored distance is clamped: four, less the way to the corner.
const float TRUSTED_VOXELS = 2.8;
const float BAND_TEXELS = 4.0, INSIDE_BAND_TEXELS = 5.0;
// Closed parts are at least so thick near them, and as thin as they are from so far away on.
const float THICK_TEXELS = 1.15, FADED_TEXELS = 2.0;
const float KINK_VOXELS = 0.3;
const int MOST_ROUNDS = 5, LOOK_AROUND_ROUND = 3, MOST_FAILURES = 2;
// Between samples a distance may fall about this much below the truth where two surfaces are equally far away.
const float CERTAIN_TEXELS = 0.03;
// Where bounds stand this close together the search ends.
const float ACCURATE_TEXELS = 0.015;

// An object as texels of one size see it.
struct FieldObject {
  SdfInstance instance;
  vec3 gridOrigin; // of anchored space
  int firstLevel; // no finer one is read: its voxels are at most an eighth of a texel, or it is the finest
  float fineVoxel; // of that level, grid voxels
  float texelMetres;
  bool isSimilar; // distances in the grid are distances in the world
};

FieldObject fieldObject(SdfInstance instance, vec3 gridOrigin, float texelMetres) {
  float level = clamp(floor(log2(texelMetres / instance.boxMin.w)) - 3.0, 0.0, float(instance.ids.z - 1));
  bool isSimilar = instance.boxMin.w < 1.001 * instance.boxMax.w;
  return FieldObject(instance, gridOrigin, int(level), exp2(level), texelMetres, isSimilar);
}

struct BrickReading {
  SdfLevel level;
  uint cell;        // the brick; CELL_EMPTY where there is none
  vec3 brickOrigin; // level voxels
  vec3 pointLevel;
  float grid;  // the distance, negative inside
  float voxel; // of the level; grid voxels both
};

// From the finest level that holds a distance there and no clamp; the coarsest is clamped nowhere.
BrickReading readObject(FieldObject object, vec3 pointGrid) {
  int last = object.instance.ids.z - 1;
  BrickReading reading;
  for (int i = object.firstLevel; i <= last; ++i) {
    SdfLevel level = sdfLevels[object.instance.ids.y + i];
    reading.level = level;
    reading.voxel = 1.0 / level.scale.x;
    reading.pointLevel = clamp(pointGrid * level.scale.x, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
    ivec3 brick = brickOfPoint(level, reading.pointLevel);
    reading.brickOrigin = vec3(brick) * float(BRICK_CELLS);
    reading.cell = cellOfBrick(level.cells.x, level, brick);
    bool isEmpty = (reading.cell & CELL_EMPTY) != 0u;
    if (isEmpty && i < last) continue;
    float voxels = isEmpty ? boundOfCell(reading.cell)
                           : brickDistance(level, reading.cell, reading.pointLevel - reading.brickOrigin);
    reading.grid = voxels * reading.voxel;
    if (abs(voxels) < TRUSTED_VOXELS) break;
  }
  return reading;
}

// Grid voxels, negative inside, from the coarsest level, which is clamped nowhere: reads of several places need not wait
// for each other's levels.
float coarsestDistance(FieldObject object, vec3 pointGrid) {
  SdfLevel level = sdfLevels[object.instance.ids.y + object.instance.ids.z - 1];
  return fieldDistance(level, pointGrid * level.scale.x) / level.scale.x;
}

struct SurfacePoint {
  vec3 pointGrid;
  vec3 normalGrid; // unit
};

// The surface point that the brick of a reading leads to from there, or from as near as six reads in the brick permit.
// Differences over two voxels interpolate those of the samples.
SurfacePoint surfaceFrom(BrickReading reading) {
  vec3 middle = clamp(reading.pointLevel - reading.brickOrigin, vec3(1.0), vec3(float(BRICK_CELLS) - 1.0));
  vec3 gradient = vec3(0.0);
  float mean = 0.0;
  if ((reading.cell & CELL_EMPTY) == 0u) {
    for (int axis = 0; axis < 3; ++axis) {
      vec3 offset = vec3(axis == 0, axis == 1, axis == 2);
      float above = brickDistance(reading.level, reading.cell, middle + offset);
      float below = brickDistance(reading.level, reading.cell, middle - offset);
      gradient[axis] = 0.5 * (above - below);
      mean += (above + below) / 6.0;
    }
  }
  // Midway between surfaces any of them will do.
  if (dot(gradient, gradient) < 0.01) gradient += vec3(0.05, 0.1, 0.07);
  vec3 normal = normalize(gradient);
  return SurfacePoint((reading.brickOrigin + middle - normal * mean) * reading.voxel, normal);
}

vec3 timesRows(vec4 rows[3], vec3 direction) {
  return vec3(dot(rows[0].xyz, direction), dot(rows[1].xyz, direction), dot(rows[2].xyz, direction));
}

vec3 gridPoint(FieldObject object, vec3 pointAnchored) {
  return timesRows(object.instance.gridFromWorld, pointAnchored - object.gridOrigin);
}

float lengthWorld(SdfInstance instance, vec3 wayGrid) { return length(timesRows(instance.worldFromGrid, wayGrid)); }

// Of the world, unit; w: metres that a grid voxel spans along it.
vec4 normalWorld(SdfInstance instance, vec3 normalGrid) {
  vec3 normal = instance.gridFromWorld[0].xyz * normalGrid.x + instance.gridFromWorld[1].xyz * normalGrid.y +
                instance.gridFromWorld[2].xyz * normalGrid.z;
  float metres = inversesqrt(dot(normal, normal));
  return vec4(normal * metres, metres);
}

vec3 clampToBox(SdfInstance instance, vec3 pointGrid) {
  return clamp(pointGrid, instance.boxMin.xyz, instance.boxMax.xyz);
}

// Lower bound, metres, of the distance to the object's box; may be less where the transform is no similarity.
float boxDistance(FieldObject object, vec3 pointAnchored) {
  vec3 p = gridPoint(object, pointAnchored);
  return object.instance.boxMax.w * distance(p, clampToBox(object.instance, p));
}

// How much of a way from a point in the box stays in it, at most 1.
float partInBox(SdfInstance instance, vec3 pointGrid, vec3 wayGrid) {
  vec3 room = mix(instance.boxMin.xyz, instance.boxMax.xyz, greaterThan(wayGrid, vec3(0.0))) - pointGrid;
  vec3 parts = mix(room / wayGrid, vec3(1.0), lessThan(abs(wayGrid), vec3(1e-6)));
  return clamp(min(parts.x, min(parts.y, parts.z)), 0.0, 1.0);
}

// What is known of the distance from a point.
struct ObjectDistance {
  vec3 pointGrid;
  float side;       // -1 inside, else 1
  float lower;      // bounds of the magnitude, metres
  float upper;
  vec3 surfaceGrid; // of the upper bound
};

// The bound from below, from what was read at the point of the box that is nearest.
// Outside of the box, with q its closest point there: sqrt(max(I(q), 0)^2 + |p - q|^2) in grid voxels, because the box
// is convex and angle(p, q, surface) is no less than a right one; times the least metres of a voxel. What is read may
// exceed the truth: a distance d curves by at most 1/d along two axes, which adds up to voxel^2/8 * 2/d; nearer than
// two voxels less is taken off, lest it steps where the level changes.
ObjectDistance boundOf(FieldObject object, vec3 pointGrid, BrickReading reading) {
  vec3 q = clampToBox(object.instance, pointGrid);
  float outer = distance(pointGrid, q), read = abs(reading.grid);
  bool isInside = reading.grid < 0.0 && outer == 0.0;
  float voxel = reading.voxel, excess = 0.25 * voxel * voxel / max(read - 0.5 * voxel, 2.0 * voxel);
  float inner = max((isInside ? read : reading.grid) - excess, 0.0);
  float lower = object.instance.boxMax.w * (outer > 0.0 ? length(vec2(inner, outer)) : inner);
  return ObjectDistance(pointGrid, isInside ? -1.0 : 1.0, lower, lower, q);
}

bool isInBand(FieldObject object, ObjectDistance bound) {
  return bound.lower < (bound.side < 0.0 ? INSIDE_BAND_TEXELS : BAND_TEXELS) * object.texelMetres;
}

// What was read in the box is the distance itself.
bool isExact(FieldObject object, ObjectDistance bound, BrickReading reading) {
  bool isFine = reading.voxel * object.instance.boxMin.w <= 0.125 * object.texelMetres;
  bool isClose = reading.voxel == object.fineVoxel && abs(reading.grid) < 1.5 * object.fineVoxel;
  return object.isSimilar && bound.pointGrid == bound.surfaceGrid && (isFine || isClose);
}

// The way in the world from a surface point to one that is nearer to the point `away` from it: to the foot of that on
// the tangent plane, on a sphere through the surface there, whose radius the distance of a point on the plane tells.
vec3 wayAlongSurface(FieldObject object, SurfacePoint surface, vec4 normal, vec3 away) {
  vec3 toFoot = away - normal.xyz * dot(normal.xyz, away);
  vec3 toFootGrid = timesRows(object.instance.gridFromWorld, toFoot);
  float part = partInBox(object.instance, surface.pointGrid, toFootGrid), reach = part * length(toFoot);
  if (reach < 0.05 * object.texelMetres) return toFoot;
  float sag = readObject(object, surface.pointGrid + part * toFootGrid).grid * normal.w;
  if (abs(sag) < 1e-3 * reach || abs(sag) > reach) return toFoot;
  float radius = 0.5 * (reach * reach - sag * sag) / sag;
  vec3 fromCenter = away + radius * normal.xyz;
  float size = length(fromCenter);
  return size < 0.1 * abs(radius) ? toFoot : abs(radius) / size * fromCenter - radius * normal.xyz;
}

// From the farthest point in the box before a known surface point: if another surface is nearer to it, the surface
// point that the nearest of four points leads to, halfway and 45 degrees to the sides. Else, or where all of them are
// nearest to the one that is known, false.
bool lookAround(FieldObject object, ObjectDistance known, inout SurfacePoint surface) {
  vec3 way = known.pointGrid - surface.pointGrid;
  vec3 back = -way * partInBox(object.instance, surface.pointGrid, way), from = surface.pointGrid - back;
  float size = max(length(back), 1e-6);
  vec3 right = abs(back.x) < abs(back.y) ? vec3(0.0, back.z, -back.y) : vec3(-back.z, 0.0, back.x);
  right *= size / max(length(right), 1e-6);
  vec3 up = cross(back, right) / size;
  float least = 1e30, texelGrid = object.texelMetres / object.instance.boxMin.w;
  bool isNearer = false;
  vec3 at = from;
  if (known.side * coarsestDistance(object, from) > size - CERTAIN_TEXELS * texelGrid) return false;
  for (int i = 0; i < 4; ++i) {
    vec3 beside = (i < 2 ? right : up) * ((i & 1) == 0 ? 1.0 : -1.0);
    vec3 x = clampToBox(object.instance, from + 0.35355339 * (back + beside));
    float inner = known.side * coarsestDistance(object, x), sum = distance(known.pointGrid, x) + inner;
    if (sum >= least) continue;
    least = sum;
    at = x;
    isNearer = inner < distance(x, surface.pointGrid) - 2.0 * ACCURATE_TEXELS * texelGrid;
  }
  if (isNearer) surface = surfaceFrom(readObject(object, at));
  return isNearer;
}

// Searches from a surface point on. Each round reads the distance before it, on the way to the point: the sum of both
// is no less than the truth, and is the truth where they lie in line. Then the way bends along the surface.
//
//   p ---------- x - c      c: surface point of the round before; x: a voxel from it, where distances are finest
//                 \ |
//                   c'      what is nearest to x
void searchSurface(FieldObject object, inout ObjectDistance found, vec3 startGrid, int rounds, bool mayLookAround) {
  SurfacePoint surface = SurfacePoint(startGrid, vec3(0.0));
  SdfInstance instance = object.instance;
  float accurate = ACCURATE_TEXELS * object.texelMetres;
  int failures = 0;
  for (int i = 0; i < rounds; ++i) {
    vec3 way = found.pointGrid - surface.pointGrid;
    float size = max(length(way), 1e-6);
    vec3 x = clampToBox(instance, surface.pointGrid + way * min(1.0, object.fineVoxel / size));
    BrickReading reading = readObject(object, x);
    bool isFar = reading.voxel > object.fineVoxel || abs(reading.grid) > 1.5 * reading.voxel;
    float inner = found.side * reading.grid + (isFar ? KINK_VOXELS * reading.voxel : 0.0);
    float outer = lengthWorld(instance, found.pointGrid - x), metres = instance.boxMax.w;
    if (object.isSimilar && outer + inner * metres - found.lower < accurate) {
      found.upper = outer + inner * metres;
      found.surfaceGrid = surface.pointGrid;
      return;
    }
    surface = surfaceFrom(reading);
    vec4 normal = normalWorld(instance, surface.normalGrid);
    float sum = outer + inner * normal.w;
    failures += int(sum > found.upper - 0.3 * accurate);
    if (sum < found.upper) {
      found.upper = sum;
      found.surfaceGrid = surface.pointGrid;
    }
    if (found.upper - found.lower < accurate) return;
    way = found.pointGrid - surface.pointGrid;
    vec3 away = timesRows(instance.worldFromGrid, way);
    float aside = dot(away, away) - dot(normal.xyz, away) * dot(normal.xyz, away);
    bool isInLine = failures > MOST_FAILURES || aside < 0.8 * accurate * length(away); // aside / 2 length is what the next step could gain
    if (mayLookAround && (isInLine || i == LOOK_AROUND_ROUND)) {
      mayLookAround = false;
      if (!lookAround(object, found, surface)) return;
      failures = 0;
    } else if (isInLine) {
      return;
    } else {
      surface.pointGrid += timesRows(instance.gridFromWorld, wayAlongSurface(object, surface, normal, away));
    }
  }
}

// Parts thinner than a texel count as a texel thick, as those of meshes do (passes/field_refine.comp.glsl), and a little
// thicker because bricks round their sides. Where so far behind the surface, seen from the point, lies beyond the other
// side, the part is as much too thin.
//
// returns false where nothing is to be taken off
bool placeBehind(FieldObject object, ObjectDistance found, out vec3 behind) {
  float texel = object.texelMetres, share = FADED_TEXELS - found.upper / texel;
  if (share <= 0.0 || (found.side < 0.0 && share < FADED_TEXELS - 0.5)) return false;
  vec3 inwards = found.side * (found.surfaceGrid - found.pointGrid);
  float size = lengthWorld(object.instance, inwards);
  behind = clampToBox(object.instance, found.surfaceGrid + THICK_TEXELS * texel / size * inwards);
  return size >= 1e-4 * texel;
}

// Metres to be taken off for a thin part, by what was read behind it.
float thinBehind(FieldObject object, ObjectDistance found, vec3 behind, BrickReading reading) {
  float texel = object.texelMetres, share = FADED_TEXELS - found.upper / texel, thick = THICK_TEXELS * texel;
  float stepped = lengthWorld(object.instance, behind - found.surfaceGrid);
  float beyond = object.instance.boxMax.w * max(reading.grid, 0.0) + thick - stepped;
  return 0.5 * min(share, 1.0) * clamp(beyond, 0.0, thick);
}

float thinMetres(FieldObject object, ObjectDistance found) {
  vec3 behind;
  return placeBehind(object, found, behind) ? thinBehind(object, found, behind, readObject(object, behind)) : 0.0;
}

// Metres, signed. Outside nothing may exceed the truth: at most the band's end where the bound from below lies before
// it. Inside one fades into the other.
float signedDistance(FieldObject object, ObjectDistance found) {
  float upper = max(found.upper, found.lower), band = BAND_TEXELS * object.texelMetres;
  if (found.side > 0.0) return min(upper, max(found.lower, band));
  float fade = (INSIDE_BAND_TEXELS - BAND_TEXELS) * object.texelMetres;
  return -mix(upper, found.lower, clamp((found.lower - band) / fade, 0.0, 1.0));
}
