// Who is nearest, by the exact world field; beside lib/world_field.glsl. Twin: src/field/field_volume.h.
#include "lib/world_field.glsl"

layout(std430, binding = kFieldNodeBinding) readonly buffer WorldFieldNodeBlock { uint worldFieldNodes[]; };

// Number + 1 of the node nearest to a point, where the eight texels around it agree, of the finest cascade that knows;
// FIELD_NODE_UNCERTAIN where they name different ones, 0 where nobody is in range.
uint fieldNode(vec3 pointAnchored) {
  bool isSplit = false;
  for (int c = 0; c < int(field.counts.x); ++c) {
    FieldCascade cascade = field.cascades[c];
    vec3 lattice = pointAnchored * cascade.texel.y;
    if (!isHeldByField(fieldDepth(c, lattice))) continue;
    ivec3 lowest = ivec3(floor(lattice - 0.5));
    uint least = FIELD_NODE_UNCERTAIN, most = 0u;
    for (int corner = 0; corner < 8; ++corner) {
      ivec3 texel = lowest + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      uint node = worldFieldNodes[texelWord(cascade, texel)] & FIELD_NODE_MASK;
      least = min(least, node);
      most = max(most, node);
    }
    if (least == most && most != 0u) return most;
    if (least != 0u) return FIELD_NODE_UNCERTAIN;
    isSplit = isSplit || most != 0u; // some know and some don't: the coarser cascade sees farther
  }
  return isSplit ? FIELD_NODE_UNCERTAIN : 0u;
}
