// Rays against all world triangles, in anchored space. The closest hit; of triangles at the same distance the lowest
// number, so that the tree's shape does not show. Both sides of every triangle are hit.
//
// Triangles are tested as in Woop, Benthin and Wald 2013: corners are carried into a frame whose third axis is the ray,
// where three edge functions decide; two triangles compute the function of a shared edge from the same numbers, `precise`,
// so no ray slips between them. Their shear is a rotation here, which branches less and is as watertight. What
// they do in double where an edge function is exactly 0 is not done: then the edge counts as inside for both. Boxes are
// widened as in Ize 2013, and by what rounding may move a corner in the ray's frame: else a ray along two boxes' common
// side may be sent to the one triangle and meet the other.
#include "lib/finite.glsl"
#include "shared/triangle_hierarchy_params.h"
#include "shared/world_field_params.h"

layout(std430, binding = kHierarchyNodeBinding) readonly buffer HierarchyNodeBlock { HierarchyNode hierarchyNodes[]; };
layout(std430, binding = kHierarchyOrderBinding) readonly buffer HierarchyOrderBlock { uint hierarchyOrder[]; };
layout(std430, binding = kHierarchyTriangleBinding) readonly buffer TriangleBlock { WorldTriangle worldTriangles[]; };

uniform uint hierarchyRoot;

struct RayHit {
  float distance; // along the ray, in lengths of its direction; infinite for none
  uint triangle;  // HIERARCHY_NONE for none
  bool isFront;   // seen against the normal of counter-clockwise corners
  uint nodeVisits, triangleTests;
};

const float kInfinity = uintBitsToFloat(0x7f800000u);

struct RayFrame {
  vec3 origin, right, up, direction;
};

// Any two axes that are perpendicular to a unit direction (Duff et al. 2017).
RayFrame makeRayFrame(vec3 origin, vec3 direction) {
  float s = direction.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (s + direction.z);
  float b = direction.x * direction.y * a;
  return RayFrame(origin, vec3(1.0 + s * direction.x * direction.x * a, s * b, -s * direction.x),
                  vec3(b, s + direction.y * direction.y * a, -direction.y), direction);
}

vec3 cornerInFrame(RayFrame ray, vec3 corner) {
  precise vec3 p = corner - ray.origin;
  precise vec3 result = vec3(ray.right.x * p.x + ray.right.y * p.y + ray.right.z * p.z,
                             ray.up.x * p.x + ray.up.y * p.y + ray.up.z * p.z,
                             ray.direction.x * p.x + ray.direction.y * p.y + ray.direction.z * p.z);
  return result;
}

// Distance of the hit, negative for none.
float meetTriangle(RayFrame ray, uint number) {
  if ((worldTriangles[number].codes.w & WORLD_TRIANGLE_EMPTY) != 0u) return -1.0;
  vec3 a = cornerInFrame(ray, worldTriangles[number].a.xyz);
  vec3 b = cornerInFrame(ray, worldTriangles[number].b.xyz);
  vec3 c = cornerInFrame(ray, worldTriangles[number].c.xyz);
  precise float u = c.x * b.y - c.y * b.x;
  precise float v = a.x * c.y - a.y * c.x;
  precise float w = b.x * a.y - b.y * a.x;
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return -1.0;
  float area = u + v + w;
  float t = (u * a.z + v * b.z + w * c.z) / area;
  return isFiniteDistance(t) ? abs(t) : -1.0;
}

// How far rounding may move a corner: its difference to the origin by 2^-24 of itself, each of its three coordinates
// in the ray's frame by 4 * 2^-24 of the difference's absolute sum; as much again for the rounding of the origin below.
float cornerError(vec3 origin) {
  if ((hierarchyRoot & HIERARCHY_LEAF) != 0u) return 0.0; // no boxes, or nothing at all
  HierarchyNode root = hierarchyNodes[hierarchyRoot];
  vec3 lower = min(vec3(root.x.x, root.y.x, root.z.x), vec3(root.x.z, root.y.z, root.z.z));
  vec3 upper = max(vec3(root.x.y, root.y.y, root.z.y), vec3(root.x.w, root.y.w, root.z.w));
  vec3 reach = max(abs(lower - origin), abs(upper - origin)) + abs(origin);
  return (reach.x + reach.y + reach.z) / 2097152.0; // 2^21
}

// direction  unit
// farthest   hits beyond it are none
RayHit traceHierarchy(vec3 origin, vec3 direction, float farthest) {
  RayHit hit = RayHit(kInfinity, HIERARCHY_NONE, false, 0u, 0u);
  RayFrame ray = makeRayFrame(origin, direction);
  // A component of 0 would make 0 * infinity where the ray lies in a box's side.
  vec3 safe = mix(direction, vec3(1e-18), lessThan(abs(direction), vec3(1e-18)));
  vec3 perDirection = 1.0 / safe;
  float error = cornerError(origin);
  vec4 widening = vec4(error, -error, error, -error);
  vec4 originX = origin.x + widening, originY = origin.y + widening, originZ = origin.z + widening;
  float best = farthest;
  uint stack[HIERARCHY_STACK];
  float stackNear[HIERARCHY_STACK];
  int top = 0;
  uint word = hierarchyRoot;
  while (word != HIERARCHY_NONE) {
    if ((word & HIERARCHY_LEAF) != 0u) {
      uint first = word & HIERARCHY_FIRST_MASK;
      uint count = ((word & ~HIERARCHY_LEAF) >> HIERARCHY_COUNT_SHIFT) + 1u;
      hit.triangleTests += count;
      for (uint i = 0u; i < count; ++i) {
        uint number = hierarchyOrder[first + i];
        float t = meetTriangle(ray, number);
        if (t < 0.0 || t > best || (t == best && number > hit.triangle)) continue;
        best = t;
        hit.distance = t;
        hit.triangle = number;
      }
      word = HIERARCHY_NONE;
    } else {
      ++hit.nodeVisits;
      HierarchyNode node = hierarchyNodes[word];
      vec4 x = (node.x - originX) * perDirection.x;
      vec4 y = (node.y - originY) * perDirection.y;
      vec4 z = (node.z - originZ) * perDirection.z;
      vec2 near = max(max(min(x.xz, x.yw), min(y.xz, y.yw)), max(min(z.xz, z.yw), 0.0));
      vec2 far = min(min(max(x.xz, x.yw), max(y.xz, y.yw)), max(z.xz, z.yw));
      far *= 1.0000004; // 1 + 2 gamma(3): Ize 2013
  bvec2 isMet = bvec2(near.x <= min(far.x, best) && node.x.x <= node.x.y,
                          near.y <= min(far.y, best) && node.x.z <= node.x.w);
      word = HIERARCHY_NONE;
      if (isMet.x && isMet.y) {
        bool leftFirst = near.x <= near.y;
        word = leftFirst ? node.children.x : node.children.y;
        stack[top] = leftFirst ? node.children.y : node.children.x;
        stackNear[top++] = leftFirst ? near.y : near.x;
      } else if (isMet.x) {
        word = node.children.x;
      } else if (isMet.y) {
        word = node.children.y;
      }
    }
    while (word == HIERARCHY_NONE && top > 0) {
      --top;
      if (stackNear[top] <= best) word = stack[top];
    }
  }
  if (hit.triangle != HIERARCHY_NONE) {
    vec3 a = worldTriangles[hit.triangle].a.xyz;
    vec3 normal = cross(worldTriangles[hit.triangle].b.xyz - a, worldTriangles[hit.triangle].c.xyz - a);
    hit.isFront = dot(normal, direction) < 0.0;
  }
  return hit;
}
