// Each triangle leaves its keys in the texels around it: a thread a triangle, while it has few, so that none waits long
// for the largest of many. Larger ones are listed for field_splat_parts.
#include "lib/field_splat.glsl"

layout(local_size_x = GATHER_TRIANGLES) in;

layout(std430, binding = kFieldListBinding) readonly buffer SplatBlock { FieldSplat splats[]; };
layout(std430, binding = kFieldSplatBinding) buffer PartBlock {
  uint partCount;
  uint unusedA, unusedB, unusedC;
  uvec2 parts[]; // triangle; cascade << SPLAT_CASCADE_SHIFT | part
};

uniform uint listLength;

const float MOST_TEXELS_OF_ONE_THREAD = 128.0;
const float MOST_TEXELS_OF_ONE_PART = float(SPLAT_PART_TEXELS * SPLAT_PART_TEXELS * SPLAT_PART_TEXELS);
// From a part's centre to its outermost texel centres, sqrt(3) * 7.5, and rounding.
const float PART_HALF_DIAGONAL = 12.990382 + 0.01;

shared uint larger[GATHER_TRIANGLES];
shared uint largerCount;

// One loop: threads of unlike boxes go through it together. Texels are counted from where the triangle's own box begins,
// whatever of it is made anew: they get the same keys in every bit.
void splatWhole(FieldCascade cascade, SplatTriangle t, SplatBox box) {
  vec3 begin = ceil(t.low - (SPLAT_TEXELS + 0.5)), corner = inFrame(t, begin + 0.5);
  vec3 stepX = vec3(t.along.x, t.up.x, t.normal.x), stepY = vec3(t.along.y, t.up.y, t.normal.y);
  vec3 stepZ = vec3(t.along.z, t.up.z, t.normal.z);
  vec3 first = vec3(box.lower) - begin, steps = first;
  ivec3 at = box.lower;
  int endX = at.x + box.alongX, endY = at.y + box.plane / box.alongX;
  int tiles = cascade.window.w >> 3;
  // Where a box is clipped decides which of both places makes a row: precise, else one may be rounded in another way.
  precise vec3 row = corner + steps.y * stepY + steps.z * stepZ;
  uvec3 parts = texelWordParts(cascade, at);
  uint rowWord = cascade.buffers.x + parts.y + parts.z;
  for (int i = 0; i < box.count; ++i) {
    uint alongX = uint(at.x >> 3 & tiles - 1) * FIELD_TILE_TEXELS + uint(at.x & 7);
    splatInFrame(t, row + steps.x * stepX, rowWord + alongX);
    ++at.x, steps.x += 1.0;
    if (at.x < endX) continue;
    at.x = box.lower.x, steps.x = first.x;
    ++at.y, steps.y += 1.0;
    if (at.y == endY) at.y = box.lower.y, steps.y = first.y, ++at.z, steps.z += 1.0;
    row = corner + steps.y * stepY + steps.z * stepZ;
    parts = texelWordParts(cascade, at);
    rowWord = cascade.buffers.x + parts.y + parts.z;
  }
}

void listPart(uint cascadeIndex, FieldCascade cascade, SplatTriangle t, uint part) {
  uint place = atomicAdd(partCount, 1u);
  if (place < SPLAT_PART_CAPACITY) {
    parts[place] = uvec2(t.number, cascadeIndex << SPLAT_CASCADE_SHIFT | part);
    return;
  }
  SplatBox box = splatPart(cascadeIndex, cascade, t, part); // slower, but the same in every bit
  for (int i = 0; i < box.count; ++i) splatAt(cascade, t, texelOfBox(box, i));
}

void splatTriangleOf(uint cascadeIndex, FieldCascade cascade, uint number) {
  if ((triangles[number].codes.w & WORLD_TRIANGLE_EMPTY) != 0u) return;
  SplatTriangle t = splatTriangle(cascade, number);
  SplatBox box = splatPart(cascadeIndex, cascade, t, SPLAT_WHOLE);
  if (box.count == 0) return;
  // Whatever is made anew of what it reaches: the same triangle goes the same way, to the same keys in every bit.
  float reached = reachedTexels(t);
  if (reached <= MOST_TEXELS_OF_ONE_THREAD)
    splatWhole(cascade, t, box);
  else if (reached <= MOST_TEXELS_OF_ONE_PART)
    listPart(cascadeIndex, cascade, t, SPLAT_WHOLE);
  else
    larger[atomicAdd(largerCount, 1u)] = number;
}

// The group's threads take a part each.
void listParts(uint cascadeIndex, FieldCascade cascade, SplatTriangle t) {
  const int side = int(SPLAT_PART_TEXELS);
  uint thread = gl_LocalInvocationIndex;
  ivec3 lower, upper;
  splatBounds(cascadeIndex, t, lower, upper);
  // A part's half extent along the normal, and the reach of the keys.
  float thick = 0.5 * float(side) * dot(abs(t.normal), vec3(1.0)) + SPLAT_TEXELS;
  float around = PART_HALF_DIAGONAL + SPLAT_TEXELS;
  ivec3 first = (lower - cascade.window.xyz) / side, count = (upper - cascade.window.xyz) / side - first + 1;
  for (int i = int(thread); i < count.x * count.y * count.z; i += int(GATHER_TRIANGLES)) {
    ivec3 part = first + ivec3(i % count.x, i / count.x % count.y, i / (count.x * count.y));
    vec3 center = inFrame(t, vec3(cascade.window.xyz + part * side) + 0.5 * float(side));
    if (abs(center.z) <= thick && squaredDistance(t, center) <= around * around)
      listPart(cascadeIndex, cascade, t, uint(part.z) << 10 | uint(part.y) << 5 | uint(part.x));
  }
}

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  FieldSplat splat = splats[index];
  FieldCascade cascade = field.cascades[splat.cascade];
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) largerCount = 0u;
  barrier();
  if (thread < splat.count) splatTriangleOf(splat.cascade, cascade, splat.firstTriangle + thread);
  barrier();
  for (uint i = 0u; i < largerCount; ++i) listParts(splat.cascade, cascade, splatTriangle(cascade, larger[i]));
}
