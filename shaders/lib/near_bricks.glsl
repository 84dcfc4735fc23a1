// Exact distances beside surfaces, from the bricks of the objects that the texels around a point say are nearest; what
// the world field rounds off within a texel they know to a fraction of a voxel. Far from surfaces the field is exact
// enough and alone; so it is where it says that nothing is as near as its reader could tell from farther.
//
//   texels   1 and what the reader tells apart        0
//   field  --|
//   bricks   |========================================|  the coarsest voxels that the distance and the reader permit
#include "lib/bricks.glsl"
#include "lib/world_field_nodes.glsl"

// For each node: first row of its instances | count << 24; NO_BRICKS where it has none.
layout(std430, binding = kNodeRowBinding) readonly buffer NodeRowBlock { uint nodeRows[]; };

// The field makes things thicker by half a texel, and more where they are thin.
const float BRICKS_END_TEXELS = 1.0;
const uint MOST_NODE_INSTANCES = 8u;
// By as much the field may make an object nearer than it is: thin ones are a texel thick in it.
const float THICKENED_TEXELS = 0.75;
// Level voxels: up to here no corner that weighs in a stored distance is clamped; and nearer than half of that, the next
// finer level is not clamped either.
const float UNCLAMPED_VOXELS = 2.8, FINER_VOXELS = 1.4;

struct NearDistance {
  float distanceWorld; // metres, negative inside
  float grain;         // metres: nothing in it is finer
  uint reads;
};

// The rows of up to four of the nodes that the eight texels around a place name, as in nodeRows; 0: no more. Whether
// these are all: others have no bricks, or are too many. Kept while a ray stays between the same texels.
uvec4 rowsBetweenTexels = uvec4(0u);
bool areAllBetweenTexels = true;
uint lowestTexelWord = FIELD_NONE; // whose they are

void findRows(FieldCascade cascade, ivec3 lowest) {
  uint word = texelWord(cascade, lowest);
  if (word == lowestTexelWord) return;
  lowestTexelWord = word;
  rowsBetweenTexels = uvec4(0u);
  areAllBetweenTexels = true;
  uvec4 known = uvec4(0u);
  for (int corner = 0; corner < 8; ++corner) {
    uint node = worldFieldNodes[texelWord(cascade, lowest + ivec3(corner & 1, corner >> 1 & 1, corner >> 2))] & FIELD_NODE_MASK;
    if (node == 0u || any(equal(known, uvec4(node)))) continue;
    uint row = nodeRows[node - 1u];
    if (known.w != 0u || row == NO_BRICKS) {
      areAllBetweenTexels = false;
      continue;
    }
    if ((row >> 24) > MOST_NODE_INSTANCES) areAllBetweenTexels = false;
    known = uvec4(node, known.xyz);
    rowsBetweenTexels = uvec4(row, rowsBetweenTexels.xyz);
  }
}

vec3 timesGridRows(uint row, vec3 wayAnchored) {
  return vec3(dot(sdfInstances[row].gridFromWorld[0].xyz, wayAnchored), dot(sdfInstances[row].gridFromWorld[1].xyz, wayAnchored),
              dot(sdfInstances[row].gridFromWorld[2].xyz, wayAnchored));
}

// Grid voxels, negative inside; y: of the level that was read, grid voxels. First from the finest level that is not
// clamped if the field is right; from coarser ones where it is wrong, from finer ones where these can tell more.
//
// leastMetres  that a grid voxel spans
vec2 readFineEnough(int firstLevel, int levels, vec3 pointGrid, float metres, float leastMetres, float fineMetres, inout uint reads) {
  vec2 found = vec2(0.0);
  int i = clamp(int(ceil(log2(abs(metres) / (UNCLAMPED_VOXELS * leastMetres) + 1e-3))), 0, levels - 1), way = 0;
  for (;;) {
    SdfLevel level = sdfLevels[firstLevel + i];
    vec3 pointLevel = clamp(pointGrid * level.scale.x, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
    ivec3 brick = brickOfPoint(level, pointLevel);
    uint cell = cellOfBrick(level.cells.x, level, brick);
    bool isEmpty = (cell & CELL_EMPTY) != 0u, isLast = i == levels - 1;
    float voxels = isEmpty ? boundOfCell(cell) : brickDistance(level, cell, pointLevel - vec3(brick) * float(BRICK_CELLS));
    if (!isEmpty || isLast) ++reads;
    if (!isLast && (isEmpty || abs(voxels) > UNCLAMPED_VOXELS)) {
      if (way < 0) break;
      way = 1;
    } else {
      found = vec2(voxels, 1.0) / level.scale.x;
      bool isFar = abs(voxels) > FINER_VOXELS && leastMetres * abs(found.x) > fineMetres;
      if (i == 0 || way > 0 || isFar) break;
      way = -1;
    }
    i += way;
  }
  return found;
}

// The distance to one object. Beyond its box it lies between two bounds, and the field tells where.
//
// mostMetres  what is farther than this is not joined
void joinObject(uint row, vec3 pointAnchored, float metres, float mostMetres, float fineMetres, inout NearDistance nearest) {
  vec3 gridOrigin = vec3(sdfInstances[row].worldFromGrid[0].w, sdfInstances[row].worldFromGrid[1].w, sdfInstances[row].worldFromGrid[2].w);
  vec4 boxMin = sdfInstances[row].boxMin, boxMax = sdfInstances[row].boxMax;
  vec3 pointGrid = timesGridRows(row, pointAnchored - (gridOrigin - field.anchor.xyz)), q = clamp(pointGrid, boxMin.xyz, boxMax.xyz);
  float outer = distance(pointGrid, q), least = boxMax.w, most = boxMin.w;
  if (least * outer > mostMetres + most || least * outer >= nearest.distanceWorld) return;
  ivec4 ids = sdfInstances[row].ids;
  vec2 read = readFineEnough(ids.y, ids.z, q, metres, least, fineMetres, nearest.reads);
  float lower = outer > 0.0 ? least * length(vec2(max(read.x, 0.0), outer)) : min(least * read.x, most * read.x);
  float upper = outer > 0.0 ? most * (max(read.x, 0.0) + outer) : max(least * read.x, most * read.x);
  float found = clamp(metres, lower, upper);
  if (found >= nearest.distanceWorld) return;
  nearest.distanceWorld = found;
  nearest.grain = most * read.y;
}

uint endOfRow(uint row) { return (row & 0xffffffu) + min(row >> 24, MOST_NODE_INSTANCES); }

// The least distance to the objects whose rows were found last.
void joinRows(vec3 pointAnchored, float metres, float mostMetres, float fineMetres, inout NearDistance nearest) {
  for (uvec4 rows = rowsBetweenTexels; rows.x != 0u; rows = uvec4(rows.yzw, 0u))
    for (uint row = rows.x & 0xffffffu; row < endOfRow(rows.x); ++row) joinObject(row, pointAnchored, metres, mostMetres, fineMetres, nearest);
}

bool isBesideSurface(FieldReading reading, float besideMetres) {
  return reading.cascade >= 0 && abs(reading.distanceWorld) <= besideMetres;
}

// Whether what the field reads is of the objects that were joined.
bool isMeant(NearDistance nearest, float metres, float texel) {
  return nearest.distanceWorld < 3e38 && (areAllBetweenTexels || nearest.distanceWorld - metres < THICKENED_TEXELS * texel);
}

// What was read of one cascade, made exact by the bricks of the objects around. What has none there is as near as the
// field says, unless what the field says of an object with bricks explains it.
//
// fineMetres  what the reader tells apart: distances beyond it are all the same to it
NearDistance refineByBricks(vec3 pointAnchored, FieldReading reading, float texel, float fineMetres) {
  NearDistance refined = NearDistance(reading.distanceWorld, texel, 0u);
  if (!isBesideSurface(reading, BRICKS_END_TEXELS * texel + fineMetres)) return refined;
  FieldCascade cascade = field.cascades[reading.cascade];
  findRows(cascade, ivec3(floor(pointAnchored * cascade.texel.y - 0.5)));
  NearDistance nearest = NearDistance(3.4e38, texel, 0u);
  joinRows(pointAnchored, reading.distanceWorld, abs(reading.distanceWorld) + THICKENED_TEXELS * texel, fineMetres, nearest);
  refined.reads = nearest.reads;
  if (isMeant(nearest, reading.distanceWorld, texel)) return nearest;
  return refined;
}
