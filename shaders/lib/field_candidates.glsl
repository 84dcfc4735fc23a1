// The nearest of some world triangles. What is compared is the value that the field would take: sheets lie half their
// thickness nearer than their triangle.
#include "lib/triangle_distance.glsl"
#include "shared/bindings.h"
#include "shared/world_field_params.h"

layout(std430, binding = kWorldTriangleBinding) readonly buffer WorldTriangleBlock { WorldTriangle triangles[]; };

struct Nearest {
  uint triangle; // FIELD_NONE: none yet
  float rank;    // metres
};

// Ties go to the lower number, whatever the order of asking.
void consider(uint triangle, vec3 point, float sheetHalf, inout Nearest nearest) {
  if (triangle == FIELD_NONE || triangle == nearest.triangle) return;
  vec3 a = triangles[triangle].a.xyz, b = triangles[triangle].b.xyz, c = triangles[triangle].c.xyz;
  bool isClosed = (triangles[triangle].codes.w & WORLD_TRIANGLE_CLOSED) != 0u;
  float rank = sqrt(squaredTriangleDistance(point, a, b, c)) + (isClosed ? sheetHalf : 0.0);
  if (rank < nearest.rank || (rank == nearest.rank && triangle < nearest.triangle)) nearest = Nearest(triangle, rank);
}
