// How a triangle leaves its keys; for the passes that splat small triangles and parts of large ones.
#include "lib/field_keys.glsl"

layout(std430, binding = kFieldKeyBinding) buffer KeyBlock { uint keys[]; };

// A triangle in a frame of its own: the longest edge lies on the first axis, the third corner above it, and heights
// over the plane are the third coordinate. Made once, it answers for many points.
struct SplatTriangle {
  uint number;
  float extra;             // texels that its rank lies above its distance
  vec3 low, high;          // its box, texels
  vec3 origin;             // texels; a corner
  vec3 along, up, normal;  // axes of the frame, unit
  vec2 tip;                // the third corner; the second is (lengths.x, 0)
  vec2 toTip, fromTip;     // unit directions of the other edges
  vec3 lengths;            // of the edges, texels
};

SplatTriangle splatTriangle(FieldCascade cascade, uint number) {
  WorldTriangle t = triangles[number];
  vec3 a = t.a.xyz * cascade.texel.y, b = t.b.xyz * cascade.texel.y, c = t.c.xyz * cascade.texel.y;
  SplatTriangle s;
  s.number = number;
  s.extra = (t.codes.w & WORLD_TRIANGLE_CLOSED) != 0u ? cascade.texel.w : 0.0;
  s.low = min(a, min(b, c)), s.high = max(a, max(b, c));
  vec3 squares = vec3(dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c));
  if (squares.y >= squares.x && squares.y >= squares.z) {
    vec3 first = a;
    a = b, b = c, c = first;
  } else if (squares.z >= squares.x) {
    vec3 first = a;
    a = c, c = b, b = first;
  }
  vec3 ab = b - a, ac = c - a;
  s.origin = a;
  s.lengths.x = length(ab);
  s.along = s.lengths.x > 0.0 ? ab / s.lengths.x : vec3(1.0, 0.0, 0.0);
  vec3 above = ac - dot(ac, s.along) * s.along;
  // Without height any direction across will do.
  vec3 across = abs(s.along.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  if (dot(above, above) <= 1e-12 * squares.x) above = across - dot(across, s.along) * s.along;
  s.up = normalize(above);
  s.normal = cross(s.along, s.up);
  s.tip = vec2(dot(ac, s.along), max(dot(ac, s.up), 0.0));
  vec2 toTip = s.tip - vec2(s.lengths.x, 0.0);
  s.lengths.yz = vec2(length(toTip), length(s.tip));
  s.toTip = s.lengths.y > 0.0 ? toTip / s.lengths.y : vec2(0.0, 1.0);
  s.fromTip = s.lengths.z > 0.0 ? -s.tip / s.lengths.z : vec2(0.0, -1.0);
  return s;
}

// A point in the frame, texels.
vec3 inFrame(SplatTriangle t, vec3 point) {
  vec3 p = point - t.origin;
  return vec3(dot(p, t.along), dot(p, t.up), dot(p, t.normal));
}

// Squared distance to an edge, of a point given as (along the edge, across).
float squaredToEdge(vec2 p, float edgeLength) {
  float beyond = p.x - clamp(p.x, 0.0, edgeLength);
  return beyond * beyond + p.y * p.y;
}

float squaredDistance(SplatTriangle t, vec3 framed) {
  vec2 fromSecond = framed.xy - vec2(t.lengths.x, 0.0), fromThird = framed.xy - t.tip;
  vec2 second = vec2(dot(fromSecond, t.toTip), fromSecond.x * t.toTip.y - fromSecond.y * t.toTip.x);
  vec2 third = vec2(dot(fromThird, t.fromTip), fromThird.x * t.fromTip.y - fromThird.y * t.fromTip.x);
  float inPlane = min(squaredToEdge(framed.xy, t.lengths.x),
                      min(squaredToEdge(second, t.lengths.y), squaredToEdge(third, t.lengths.z)));
  bool isInside = max(-framed.y, max(second.y, third.y)) < 0.0;
  return (isInside ? 0.0 : inPlane) + framed.z * framed.z;
}

// Texels whose centres may be within reach, of those that are made anew; upper is included.
void splatBounds(uint cascadeIndex, SplatTriangle t, out ivec3 lower, out ivec3 upper) {
  ivec3 first = field.splatMin[cascadeIndex].xyz, last = field.splatMax[cascadeIndex].xyz;
  vec3 low = t.low - (SPLAT_TEXELS + 0.5), high = t.high + (SPLAT_TEXELS - 0.5);
  // Clamped as floats first: what lies far away is no number that an int holds.
  lower = max(ivec3(clamp(ceil(low), vec3(first - 1), vec3(last + 1))), first);
  upper = min(ivec3(clamp(floor(high), vec3(first - 1), vec3(last + 1))), last);
}

// Old values can only be larger: most texels are spared the atomic. In tiles that are not made anew the same key stands
// already, or a smaller one.
//
// framed  the texel's centre in the frame
void splatInFrame(SplatTriangle t, vec3 framed, uint word) {
  float squared = squaredDistance(t, framed);
  if (squared > SPLAT_TEXELS * SPLAT_TEXELS) return;
  uint key = keyOf(sqrt(squared) + t.extra, t.number);
  if (key < keys[word]) atomicMin(keys[word], key);
}

void splatAt(FieldCascade cascade, SplatTriangle t, ivec3 lattice) {
  splatInFrame(t, inFrame(t, vec3(lattice) + 0.5), texelWord(cascade, lattice));
}

// Texels of a box, numbered along x first.
struct SplatBox {
  ivec3 lower;
  int alongX, plane, count; // texels of a row, of a plane, and of all; none: nothing to do
  float oneOverX, oneOverPlane;
};

SplatBox splatBox(ivec3 lower, ivec3 upper) {
  ivec3 size = max(upper - lower + 1, ivec3(0));
  int plane = size.x * size.y;
  return SplatBox(lower, size.x, plane, plane * size.z, 1.0 / float(size.x), 1.0 / float(plane));
}

// Of a box of less than 2^20 texels: halves keep quotients away from whole numbers by more than floats round.
ivec3 texelOfBox(SplatBox box, int number) {
  int z = int((float(number) + 0.5) * box.oneOverPlane), inPlane = number - z * box.plane;
  int y = int((float(inPlane) + 0.5) * box.oneOverX);
  return box.lower + ivec3(inPlane - y * box.alongX, y, z);
}

// First texel of a part.
ivec3 partCorner(FieldCascade cascade, uint part) {
  return cascade.window.xyz + ivec3(part & 31u, part >> 5 & 31u, part >> 10 & 31u) * int(SPLAT_PART_TEXELS);
}

// Of a triangle, the texels to be looked at of a part, or of all.
SplatBox splatPart(uint cascadeIndex, FieldCascade cascade, SplatTriangle t, uint part) {
  ivec3 lower, upper;
  splatBounds(cascadeIndex, t, lower, upper);
  if (part == SPLAT_WHOLE) return splatBox(lower, upper);
  ivec3 corner = partCorner(cascade, part);
  return splatBox(max(lower, corner), min(upper, corner + int(SPLAT_PART_TEXELS) - 1));
}

// Texels in the box of all that a triangle may reach, whatever of them is made anew.
float reachedTexels(SplatTriangle t) {
  vec3 extent = t.high - t.low + 2.0 * SPLAT_TEXELS;
  return extent.x * extent.y * extent.z;
}
