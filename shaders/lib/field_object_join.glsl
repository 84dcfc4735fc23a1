// SDF objects and texels of the world field, for the passes that let them join.
#include "lib/field_grid.glsl"
#include "lib/field_objects.glsl"
#include "lib/near_point.glsl"

layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(std430, binding = kFieldObjectBinding) readonly buffer ObjectBlock { FieldObjectRow objectRows[]; };
layout(binding = 0, r16f) uniform image3D distances[MOST_CASCADES];

// A way by the surface point that the grid around a field names is the shortest where it is no longer than this beyond the
// grid's distance, and the grid's cells are no larger than that.
const float AGREED_TEXELS = 0.012, MOST_CELL_TEXELS = 1.3;

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

Place placeOf(uint listed) {
  ListedTile tile = listedTile(listed);
  FieldCascade cascade = field.cascades[tile.cascade];
  float texelMetres = cascade.texel.x;
  return Place(cascade, tile, (vec3(tile.firstTexel) + 0.5 * float(FIELD_TILE)) * texelMetres,
               0.8660255 * float(FIELD_TILE - 1u) * texelMetres);
}

// Of a tile's word in the buffer of tiles.
Place placeOfTile(uint word) {
  uint cascade = field.counts.x - 1u;
  while (cascade > 0u && field.cascades[cascade].buffers.z > word) --cascade;
  return placeOf(cascade << 24 | (word - field.cascades[cascade].buffers.z));
}

FieldObject objectAt(Place place, uint number) {
  SdfInstance instance = SdfInstance(objectRows[number].gridFromAnchored, sdfInstances[number].worldFromGrid,
                                     objectRows[number].boxMin, objectRows[number].boxMax, objectRows[number].ids);
  vec4 rows[3] = instance.gridFromWorld;
  return fieldObject(instance, vec3(rows[0].w, rows[1].w, rows[2].w), place.cascade.texel.x);
}

// The node's word of a texel that an object is nearest to; what it says of meshes stays: updates to come ask for it.
uint wordOf(FieldObject object, uint word) { return (uint(object.instance.ids.x) + 1u) | (word & ~FIELD_NODE_MASK); }

// Whether a value is nearer than what is known; made one that can be stored.
bool isNearer(Place place, FieldObject object, inout float value, float metres, uint word) {
  float range = place.cascade.texel.z * place.cascade.texel.x;
  value = max(value, -range);
  uint node = uint(object.instance.ids.x) + 1u;
  return value < metres || (value == metres && value < range && node < (word & FIELD_NODE_MASK));
}

// Whether the grid around the field is fine enough to be believed.
bool isTold(Place place, FieldObjectRow row) {
  bool isSimilar = row.boxMin.w < 1.001 * row.boxMax.w;
  return isSimilar && row.points.w * row.boxMax.w < MOST_CELL_TEXELS * place.cascade.texel.x;
}
