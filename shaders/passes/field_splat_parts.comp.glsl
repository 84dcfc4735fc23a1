// What is listed of large triangles. Of those that have few texels all; of a part the threads look at a block of 4^3
// texels each, then all fill the blocks that are near.
#include "lib/field_splat.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldSplatBinding) readonly buffer PartBlock {
  uint partCount;
  uint unusedA, unusedB, unusedC;
  uvec2 parts[];
};

const uint BLOCKS = 64u;
shared uint nearBlocks[BLOCKS];
shared uint nearCount;

const int BLOCK = 4;
const float BLOCK_HALF_DIAGONAL = 2.5980763; // from its centre to its outermost texel centres, sqrt(3) * 1.5

void splatBlocks(FieldCascade cascade, SplatTriangle t, ivec3 corner) {
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) nearCount = 0u;
  barrier();
  if (thread < BLOCKS) {
    vec3 center = vec3(corner + cubeIndex(int(thread), BLOCK) * BLOCK) + 0.5 * float(BLOCK);
    float reach = SPLAT_TEXELS + BLOCK_HALF_DIAGONAL + 1e-3;
    if (squaredDistance(t, inFrame(t, center)) <= reach * reach) nearBlocks[atomicAdd(nearCount, 1u)] = thread;
  }
  barrier();
  for (uint block = thread / BLOCKS; block < nearCount; block += gl_WorkGroupSize.x / BLOCKS) {
    ivec3 first = corner + cubeIndex(int(nearBlocks[block]), BLOCK) * BLOCK;
    ivec3 lattice = first + cubeIndex(int(thread % BLOCKS), BLOCK);
    if (isInWindow(cascade, lattice)) splatAt(cascade, t, lattice);
  }
  barrier();
}

void main() {
  uint count = min(partCount, SPLAT_PART_CAPACITY);
  for (uint at = gl_WorkGroupID.x; at < count; at += gl_NumWorkGroups.x) {
    uint cascadeIndex = parts[at].y >> SPLAT_CASCADE_SHIFT, part = parts[at].y & 0xffffu;
    FieldCascade cascade = field.cascades[cascadeIndex];
    SplatTriangle t = splatTriangle(cascade, parts[at].x);
    if (part != SPLAT_WHOLE) {
      splatBlocks(cascade, t, partCorner(cascade, part));
      continue;
    }
    SplatBox box = splatPart(cascadeIndex, cascade, t, part);
    for (int i = int(gl_LocalInvocationIndex); i < box.count; i += int(gl_WorkGroupSize.x))
      splatAt(cascade, t, texelOfBox(box, i));
  }
}
