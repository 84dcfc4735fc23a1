// Marks the coarse texels that triangles touch as seeds of the flooding, each of itself. The paper takes "every point
// on each triangle" for a seed, voxelizes with the rasterizer and sees thin things torn at 64^3, so its test is hardly
// conservative. Here a voxel is a seed if its closed cube and the triangle meet (Akenine-Moeller 2001, separating
// axes): nothing is torn, and the coarse field is no larger for it than half a voxel's diagonal. Stores of one word by
// several threads all store the same.
#include "lib/finite.glsl"
#include "shared/rtsdf_params.h"
#include "shared/world_field_params.h"

layout(local_size_x = 64) in;

layout(std430, binding = kRtsdfTriangleBinding) readonly buffer TriangleBlock { WorldTriangle worldTriangles[]; };
layout(std430, binding = kRtsdfSeedBinding) writeonly buffer SeedBlock { uint seeds[]; };
layout(std430, binding = kRtsdfLargeBinding) buffer LargeBlock { uint largeCount, largeTriangles[]; };

uniform uint stage; // RTSDF_CLEAR, ...
uniform uint triangleCount;
uniform int coarseSize;
uniform vec3 originAnchored;
uniform float voxelsPerMetre;

// Coordinates are below 512, so rounding stays below 2^-14; a voxel that is missed by this much is marked too.
const float kSlack = 1.0 / 4096.0;

struct VoxelTriangle {
  vec3 a, b, c, normal; // voxels
  vec3 lower, upper;
};

// False where there is nothing to mark.
bool fetchTriangle(uint number, out VoxelTriangle t) {
  t.a = (worldTriangles[number].a.xyz - originAnchored) * voxelsPerMetre;
  t.b = (worldTriangles[number].b.xyz - originAnchored) * voxelsPerMetre;
  t.c = (worldTriangles[number].c.xyz - originAnchored) * voxelsPerMetre;
  t.normal = cross(t.b - t.a, t.c - t.a);
  t.lower = min(min(t.a, t.b), t.c) - kSlack;
  t.upper = max(max(t.a, t.b), t.c) + kSlack;
  if ((worldTriangles[number].codes.w & WORLD_TRIANGLE_EMPTY) != 0u) return false;
  return isFinite(t.a) && isFinite(t.b) && isFinite(t.c) && all(lessThan(t.lower, vec3(coarseSize))) &&
         all(greaterThan(t.upper, vec3(0.0)));
}

void voxelRange(VoxelTriangle t, out ivec3 first, out ivec3 last) {
  first = ivec3(floor(max(t.lower, vec3(0.0))));
  last = ivec3(floor(min(t.upper, vec3(coarseSize) - 0.5)));
}

bool isApartAlong(vec3 axis, vec3 a, vec3 b, vec3 c) {
  float pa = dot(axis, a), pb = dot(axis, b), pc = dot(axis, c);
  vec3 reach = abs(axis);
  float radius = (0.5 + kSlack) * (reach.x + reach.y + reach.z);
  return min(min(pa, pb), pc) > radius || max(max(pa, pb), pc) < -radius;
}

bool touches(VoxelTriangle t, ivec3 voxel) {
  vec3 center = vec3(voxel) + 0.5;
  vec3 a = t.a - center, b = t.b - center, c = t.c - center;
  if (any(greaterThan(min(min(a, b), c), vec3(0.5 + kSlack))) || any(lessThan(max(max(a, b), c), vec3(-0.5 - kSlack))))
    return false;
  if (isApartAlong(t.normal, a, b, c)) return false;
  vec3 edges[3] = vec3[](b - a, c - b, a - c);
  for (int i = 0; i < 3; ++i) {
    vec3 e = edges[i];
    if (isApartAlong(vec3(0.0, -e.z, e.y), a, b, c) || isApartAlong(vec3(e.z, 0.0, -e.x), a, b, c) ||
        isApartAlong(vec3(-e.y, e.x, 0.0), a, b, c))
      return false;
  }
  return true;
}

void mark(ivec3 voxel) {
  seeds[(voxel.z * coarseSize + voxel.y) * coarseSize + voxel.x] =
      uint(voxel.x) | uint(voxel.y) << RTSDF_SEED_BITS | uint(voxel.z) << (2u * RTSDF_SEED_BITS);
}

void voxelizeSmall(uint number) {
  VoxelTriangle t;
  if (!fetchTriangle(number, t)) return;
  ivec3 first, last;
  voxelRange(t, first, last);
  ivec3 sides = last - first + 1;
  if (uint(sides.x * sides.y * sides.z) > RTSDF_SMALL_VOXELS) {
    largeTriangles[atomicAdd(largeCount, 1u)] = number; // in any order: what is marked is the same
    return;
  }
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x)
        if (touches(t, ivec3(x, y, z))) mark(ivec3(x, y, z));
}

// The same components with `axis` last, and back. A loop that counts in a vector's component of a computed number never
// ends on NVIDIA 580.159, and the GPU hangs.
vec3 withAxisLast(vec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v; }
ivec3 withAxisLast(ivec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v; }
ivec3 fromAxisLast(ivec3 v, int axis) { return axis == 0 ? v.zxy : axis == 1 ? v.yzx : v; }

// Columns of voxels along the axis that the plane crosses most steeply: of each only the voxels around the plane.
void voxelizeLarge(uint number) {
  VoxelTriangle t;
  if (!fetchTriangle(number, t)) return;
  ivec3 first, last;
  voxelRange(t, first, last);
  vec3 steepness = abs(t.normal);
  int axis = steepness.x > steepness.y ? (steepness.x > steepness.z ? 0 : 2) : (steepness.y > steepness.z ? 1 : 2);
  first = withAxisLast(first, axis);
  last = withAxisLast(last, axis);
  vec3 normal = withAxisLast(t.normal, axis), onPlane = withAxisLast(t.a, axis);
  int width = last.x - first.x + 1;
  int columns = width * (last.y - first.y + 1);
  for (int column = int(gl_LocalInvocationIndex); column < columns; column += 64) {
    ivec2 place = first.xy + ivec2(column % width, column / width);
    ivec2 range = ivec2(first.z, last.z);
    if (abs(normal.z) > 0.0) {
      // Where the plane is at the column's middle, and how far it gets from there in half a voxel along both others.
      vec2 slopes = normal.xy / normal.z;
      float middle = onPlane.z - dot(slopes, vec2(place) + 0.5 - onPlane.xy);
      float reach = 0.5 * (abs(slopes.x) + abs(slopes.y)) + 0.01; // 1 at most; large triangles lose some digits
      range = clamp(ivec2(floor(vec2(middle - reach, middle + reach))), range.x, range.y);
    }
    for (int z = range.x; z <= range.y; ++z) {
      ivec3 voxel = fromAxisLast(ivec3(place, z), axis);
      if (touches(t, voxel)) mark(voxel);
    }
  }
}

void main() {
  // The first two stages come in rows of threads: a device may take no more than 65,535 groups along an axis.
  uint number = gl_GlobalInvocationID.y * RTSDF_ROW_THREADS + gl_GlobalInvocationID.x;
  if (stage == RTSDF_CLEAR) {
    if (number < uint(coarseSize * coarseSize * coarseSize)) seeds[number] = RTSDF_NO_SEED;
    if (number == 0u) largeCount = 0u;
  } else if (stage == RTSDF_VOXELIZE_SMALL) {
    if (number < triangleCount) voxelizeSmall(number);
  } else {
    for (uint i = gl_WorkGroupID.x; i < largeCount; i += RTSDF_LARGE_GROUPS) voxelizeLarge(largeTriangles[i]);
  }
}
