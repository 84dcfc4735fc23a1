// Exact distances beside surfaces, from the bricks of the objects that the texels around a point say are nearest; what
// the world field rounds off within a texel they know to a fraction of a voxel. Far from surfaces the field is exact
// enough and alone.
//
//   texels   2        1        0
//   field  --|========|
//   bricks            |========|  cross-faded between
#include "lib/field_objects.glsl"
#include "lib/world_field_nodes.glsl"

// For each node: first row of its instances | count << 24; NO_BRICKS where it has none.
layout(std430, binding = kNodeRowBinding) readonly buffer NodeRowBlock { uint nodeRows[]; };

const float BRICKS_ALONE_TEXELS = 1.0, BRICKS_END_TEXELS = 2.0;
const int MOST_NEAR_NODES = 4, MOST_NODE_INSTANCES = 8;

struct NearDistance {
  float distanceWorld; // metres, negative inside
  float grain;         // metres: nothing in it is finer
  uint reads;
};

// The distance to one object. Beyond its box it lies between two bounds, and the field tells where.
void joinObject(uint row, vec3 pointAnchored, float metres, inout NearDistance nearest) {
  SdfInstance instance = sdfInstances[row];
  vec3 gridOrigin = vec3(instance.worldFromGrid[0].w, instance.worldFromGrid[1].w, instance.worldFromGrid[2].w);
  FieldObject object = FieldObject(instance, gridOrigin - field.anchor.xyz, 0, 1.0, 0.0, true);
  vec3 pointGrid = gridPoint(object, pointAnchored), q = clampToBox(instance, pointGrid);
  float outer = distance(pointGrid, q), least = instance.boxMax.w, most = instance.boxMin.w;
  if (least * outer > abs(metres) + most) return; // no nearer than the field says, and a voxel
  ++nearest.reads;
  BrickReading reading = readObject(object, q);
  float lower = outer > 0.0 ? least * length(vec2(max(reading.grid, 0.0), outer)) : min(least * reading.grid, most * reading.grid);
  float upper = outer > 0.0 ? most * (max(reading.grid, 0.0) + outer) : max(least * reading.grid, most * reading.grid);
  float found = clamp(metres, lower, upper);
  if (found >= nearest.distanceWorld) return;
  nearest.distanceWorld = found;
  nearest.grain = most * reading.voxel;
}

// What was read of one cascade, made exact where all objects around have bricks.
NearDistance refineByBricks(vec3 pointAnchored, FieldReading reading, float texel) {
  NearDistance refined = NearDistance(reading.distanceWorld, texel, 0u);
  float share = (BRICKS_END_TEXELS - abs(reading.distanceWorld) / texel) / (BRICKS_END_TEXELS - BRICKS_ALONE_TEXELS);
  if (share <= 0.0 || reading.cascade < 0) return refined;
  FieldCascade cascade = field.cascades[reading.cascade];
  ivec3 lowest = ivec3(floor(pointAnchored * cascade.texel.y - 0.5));
  uint known[MOST_NEAR_NODES];
  int count = 0;
  for (int corner = 0; corner < 8; ++corner) {
    uint node = worldFieldNodes[texelWord(cascade, lowest + ivec3(corner & 1, corner >> 1 & 1, corner >> 2))] & FIELD_NODE_MASK;
    bool isKnown = false;
    for (int i = 0; i < count; ++i) isKnown = isKnown || known[i] == node;
    if (isKnown) continue;
    if (node == 0u || count == MOST_NEAR_NODES || nodeRows[node - 1u] == NO_BRICKS) return refined;
    known[count++] = node;
  }
  NearDistance nearest = NearDistance(3.4e38, texel, 0u);
  for (int i = 0; i < count; ++i) {
    uint rows = nodeRows[known[i] - 1u], first = rows & 0xffffffu, end = first + min(rows >> 24, uint(MOST_NODE_INSTANCES));
    for (uint row = first; row < end; ++row) joinObject(row, pointAnchored, reading.distanceWorld, nearest);
  }
  refined.reads = nearest.reads;
  if (nearest.distanceWorld > 3e38) return refined;
  share = min(share, 1.0);
  refined.distanceWorld = mix(reading.distanceWorld, nearest.distanceWorld, share);
  refined.grain = mix(texel, nearest.grain, share);
  return refined;
}
