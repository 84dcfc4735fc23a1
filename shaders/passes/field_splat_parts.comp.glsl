// Parts of large triangles: each thread looks at a block of 4^3 texels, then all fill the blocks that are near.
#include "lib/field_splat.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldSplatBinding) readonly buffer PartBlock {
  uint partCount;
  uint unusedA, unusedB, unusedC;
  uvec2 parts[];
};

shared uint nearBlocks[64];
shared uint nearCount;

const int BLOCK = 4;
const float BLOCK_HALF_DIAGONAL = 2.5980763; // from its centre to its outermost texel centres, sqrt(3) * 1.5

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint count = min(partCount, SPLAT_PART_CAPACITY);
  for (uint at = gl_WorkGroupID.x; at < count; at += gl_NumWorkGroups.x) {
    uvec2 part = parts[at];
    FieldCascade cascade = field.cascades[part.y >> 15];
    ivec3 corner = cascade.window.xyz + ivec3(part.y & 31u, part.y >> 5 & 31u, part.y >> 10 & 31u) * int(SPLAT_PART_TEXELS);
    SplatTriangle t = splatTriangle(cascade, part.x);
    if (thread == 0u) nearCount = 0u;
    barrier();
    vec3 center = vec3(corner + cubeIndex(int(thread), BLOCK) * BLOCK) + 0.5 * float(BLOCK);
    float reach = SPLAT_TEXELS + BLOCK_HALF_DIAGONAL + 1e-3;
    if (squaredDistance(t, inFrame(t, center)) <= reach * reach) nearBlocks[atomicAdd(nearCount, 1u)] = thread;
    barrier();
    for (uint block = 0u; block < nearCount; ++block) {
      ivec3 lattice = corner + cubeIndex(int(nearBlocks[block]), BLOCK) * BLOCK + cubeIndex(int(thread), BLOCK);
      if (isInWindow(cascade, lattice))
        splatTexel(splatRow(cascade, lattice.y, lattice.z), t, lattice.x, inFrame(t, vec3(lattice) + 0.5));
    }
    barrier();
  }
}
