// Stores what field_objects_search found, a group a tile: rasterizers on CPUs write texels of 16 bits two at a time, and
// let a group run on one thread.
#include "lib/field_object_join.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldSearchBinding) readonly buffer SearchBlock { FieldSearch searches[]; };
layout(std430, binding = kFieldOpenBinding) readonly buffer OpenBlock {
  uint searchCount, openCount;
  uvec2 open[];
};

void main() {
  uint rows = uint(searches.length());
  for (uint i = gl_WorkGroupID.x; i < openCount; i += gl_NumWorkGroups.x) {
    uint end = min(open[i].x + open[i].y, rows);
    for (uint row = open[i].x + gl_LocalInvocationIndex; row < end; row += gl_WorkGroupSize.x) {
      FieldSearch found = searches[row];
      Place place = placeOfTile(found.texel / FIELD_TILE_TEXELS);
      nodes[found.texel] = found.more;
      imageStore(distances[place.tile.cascade],
                 latticeOf(place, found.texel % FIELD_TILE_TEXELS) & (place.cascade.window.w - 1),
                 vec4(found.metres * place.cascade.texel.y));
    }
  }
}
