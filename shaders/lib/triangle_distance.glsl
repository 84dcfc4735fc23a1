// Distance from points to triangles. The closest point is always made from the triangle's own corners, so rounding never
// brings a distance below the true one by more than that of its coordinates, however thin the triangle; where a triangle
// has no area to speak of its edges answer alone. Good for edges between 1e-9 and 1e9.
#include "lib/octahedral.glsl"
#include "shared/world_field_params.h"

const uint FEATURE_FACE = 0u; // then the corners a, b, c, then the edges ab, bc, ca
const uint FEATURE_CORNER = 1u;
const uint FEATURE_EDGE = 4u;

struct TriangleHit {
  float squared; // distance, metres squared
  vec3 closest;
  uint feature; // FEATURE_*, for corners and edges plus their number
};

vec3 unitOrZero(vec3 v) {
  float squared = dot(v, v);
  return squared > 0.0 ? v * inversesqrt(squared) : vec3(0.0);
}

// Twice the triangle's area, along the normal, counter-clockwise. From the corner that faces the longest edge: the two
// shorter edges leave the least rounding.
vec3 areaNormal(vec3 a, vec3 b, vec3 c) {
  vec3 ab = b - a, bc = c - b, ca = a - c;
  float ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
  return bc2 >= ab2 && bc2 >= ca2 ? cross(ca, ab) : ca2 >= ab2 ? cross(ab, bc) : cross(bc, ca);
}

// A division that takes edges without length for points.
float shareAlong(vec3 edge, vec3 fromStart) {
  return clamp(dot(edge, fromStart) / max(dot(edge, edge), 1e-37), 0.0, 1.0);
}

// Weights of b and c at the foot on the plane; a negative one where the foot lies outside or there is no plane.
vec2 footWeights(vec3 ab, vec3 ac, vec3 ap) {
  vec3 n = cross(ab, ac);
  float n2 = dot(n, n);
  vec2 weights = vec2(dot(cross(ap, ac), n), dot(cross(ab, ap), n));
  // Of a plane that rounding tilts by a tenth of a radian or more nobody knows the sides.
  bool inside = min(weights.x, weights.y) > 0.0 && weights.x + weights.y < n2 && n2 > 1e-12 * dot(ab, ab) * dot(ac, ac);
  return inside ? weights / n2 : vec2(-1.0);
}

// The same distance as closestOnTriangle's, squared.
float squaredTriangleDistance(vec3 p, vec3 a, vec3 b, vec3 c) {
  vec3 ab = b - a, bc = c - b, ca = a - c, ap = p - a, bp = p - b, cp = p - c;
  vec3 onAb = ap - shareAlong(ab, ap) * ab, onBc = bp - shareAlong(bc, bp) * bc, onCa = cp - shareAlong(ca, cp) * ca;
  float squared = min(dot(onAb, onAb), min(dot(onBc, onBc), dot(onCa, onCa)));
  vec2 weights = footWeights(ab, -ca, ap);
  vec3 onFace = ap - weights.x * ab + weights.y * ca;
  return weights.x > 0.0 ? min(squared, dot(onFace, onFace)) : squared;
}

TriangleHit closestOnTriangle(vec3 p, vec3 a, vec3 b, vec3 c) {
  vec3 ab = b - a, bc = c - b, ca = a - c, ap = p - a, bp = p - b, cp = p - c;
  vec3 shares = vec3(shareAlong(ab, ap), shareAlong(bc, bp), shareAlong(ca, cp));
  vec3 onAb = ap - shares.x * ab, onBc = bp - shares.y * bc, onCa = cp - shares.z * ca;
  vec3 squared = vec3(dot(onAb, onAb), dot(onBc, onBc), dot(onCa, onCa));

  uint edge = squared.x <= squared.y && squared.x <= squared.z ? 0u : squared.y <= squared.z ? 1u : 2u;
  float share = shares[edge];
  TriangleHit hit;
  hit.squared = squared[edge];
  hit.closest = p - (edge == 0u ? onAb : edge == 1u ? onBc : onCa);
  hit.feature = share <= 0.0   ? FEATURE_CORNER + edge
                : share >= 1.0 ? FEATURE_CORNER + (edge + 1u) % 3u
                               : FEATURE_EDGE + edge;
  vec2 weights = footWeights(ab, -ca, ap);
  vec3 onFace = ap - weights.x * ab + weights.y * ca;
  float faceSquared = dot(onFace, onFace);
  if (weights.x > 0.0 && faceSquared <= hit.squared) hit = TriangleHit(faceSquared, p - onFace, FEATURE_FACE);
  return hit;
}

// Of a point `away` from where it is nearest to the triangle: a direction on whose side the outside lies.
vec3 pseudonormalOf(WorldTriangle t, TriangleHit hit, vec3 away) {
  if (hit.feature == FEATURE_FACE) return areaNormal(t.a.xyz, t.b.xyz, t.c.xyz);
  uint edge = hit.feature - FEATURE_EDGE;
  uint code = hit.feature == 1u   ? floatBitsToUint(t.a.w)
              : hit.feature == 2u ? floatBitsToUint(t.b.w)
              : hit.feature == 3u ? floatBitsToUint(t.c.w)
                                  : t.codes[edge];
  if ((code & 0xffffu) != WORLD_TRIANGLE_FOLDED) return directionFromOctahedral(unpackSnorm2x16(code));
  vec3 from = edge == 0u ? t.a.xyz : edge == 1u ? t.b.xyz : t.c.xyz;
  vec3 to = edge == 0u ? t.b.xyz : edge == 1u ? t.c.xyz : t.a.xyz;
  vec3 opposite = edge == 0u ? t.c.xyz : edge == 1u ? t.a.xyz : t.b.xyz;
  uint part = uint(shareAlong(to - from, hit.closest - from) * float(WORLD_TRIANGLE_FOLD_PARTS));
  bool isOutside = (code >> 16u + min(part, WORLD_TRIANGLE_FOLD_PARTS - 1u) & 1u) != 0u;
  // From the face to beyond its edge. What is nearest to the edge lies on that side, but for rounding where it is right
  // above the face, or where the face is a sliver.
  vec3 along = to - from, beyond = hit.closest - opposite;
  vec3 before = beyond - along * (dot(beyond, along) / max(dot(along, along), 1e-37));
  bool isSliver = dot(before, before) < 1e-6 * dot(beyond, beyond);
  before = (isSliver ? vec3(0.0) : unitOrZero(before)) + 0.1 * unitOrZero(away);
  return isOutside ? before : -before;
}

// Metres: negative inside closed surfaces; of sheets the distance less half their thickness.
float signedTriangleDistance(WorldTriangle t, vec3 p, float sheetHalfThickness) {
  if ((t.codes.w & WORLD_TRIANGLE_CLOSED) == 0u)
    return sqrt(squaredTriangleDistance(p, t.a.xyz, t.b.xyz, t.c.xyz)) - sheetHalfThickness;
  TriangleHit hit = closestOnTriangle(p, t.a.xyz, t.b.xyz, t.c.xyz);
  vec3 away = p - hit.closest;
  float distance = sqrt(hit.squared);
  return dot(away, pseudonormalOf(t, hit, away)) < 0.0 ? -distance : distance;
}
