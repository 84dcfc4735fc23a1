// Each triangle leaves its keys in the texels around it; parts of large ones are listed for field_splat_parts.
#include "lib/field_splat.glsl"

layout(local_size_x = GATHER_TRIANGLES) in;

layout(std430, binding = kFieldListBinding) readonly buffer SplatBlock { FieldSplat splats[]; };
layout(std430, binding = kFieldSplatBinding) buffer PartBlock {
  uint partCount;
  uint unusedA, unusedB, unusedC;
  uvec2 parts[]; // triangle; cascade << 15 | part, five bits an axis
};

uniform uint listLength;

const float MOST_TEXELS_OF_ONE_THREAD = 400.0;

void listParts(uint cascadeIndex, FieldCascade cascade, SplatTriangle t, ivec3 lower, ivec3 upper) {
  const int side = int(SPLAT_PART_TEXELS);
  // A part's half extent along the normal, and the reach of the keys.
  float reach = 0.5 * float(side) * dot(abs(t.normal), vec3(1.0)) + SPLAT_TEXELS;
  ivec3 first = (lower - cascade.window.xyz) / side, last = (upper - cascade.window.xyz) / side;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        ivec3 corner = cascade.window.xyz + ivec3(x, y, z) * side;
        if (abs(dot(vec3(corner) + 0.5 * float(side) - t.origin, t.normal)) > reach) continue;
        uint place = atomicAdd(partCount, 1u);
        if (place < SPLAT_PART_CAPACITY)
          parts[place] = uvec2(t.number, cascadeIndex << 15 | uint(z) << 10 | uint(y) << 5 | uint(x));
        else // slower, but as right
          splatBox(cascade, t, max(lower, corner), min(upper, corner + side - 1));
      }
}

void main() {
  uint index = listIndex();
  if (index >= listLength || gl_LocalInvocationIndex >= splats[index].count) return;
  uint cascadeIndex = splats[index].cascade;
  FieldCascade cascade = field.cascades[cascadeIndex];
  uint number = splats[index].firstTriangle + gl_LocalInvocationIndex;
  if ((triangles[number].codes.w & WORLD_TRIANGLE_EMPTY) != 0u) return;
  SplatTriangle t = splatTriangle(cascade, number);
  ivec3 lower, upper;
  splatBounds(cascadeIndex, t, lower, upper);
  if (any(greaterThan(lower, upper))) return;
  // Whatever is made anew of what it reaches: the same triangle goes the same way, to the same keys in every bit.
  vec3 extent = t.high - t.low + 2.0 * SPLAT_TEXELS;
  if (extent.x * extent.y * extent.z > MOST_TEXELS_OF_ONE_THREAD)
    listParts(cascadeIndex, cascade, t, lower, upper);
  else
    splatBox(cascade, t, lower, upper);
}
