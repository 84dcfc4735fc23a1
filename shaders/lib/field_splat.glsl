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

// A point in the frame, texels. Of a row of points all but the first product is the same.
vec3 inFrame(SplatTriangle t, vec3 point) {
  vec3 p = point - t.origin;
  return p.x * vec3(t.along.x, t.up.x, t.normal.x) +
         (p.y * vec3(t.along.y, t.up.y, t.normal.y) + p.z * vec3(t.along.z, t.up.z, t.normal.z));
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

// A row of texels along x as memory has it.
struct SplatRow {
  uint word; // of x = 0 in the first slot
  int slots; // tiles along x, less one
};

SplatRow splatRow(FieldCascade cascade, int y, int z) {
  uint slot = tileSlot(cascade, ivec3(0, y, z) >> 3);
  uint word = cascade.buffers.x + slot * FIELD_TILE_TEXELS + indexInTile(ivec3(0, y, z), int(FIELD_TILE));
  return SplatRow(word, (cascade.window.w >> 3) - 1);
}

uint wordOf(SplatRow row, int x) { return row.word + uint(x >> 3 & row.slots) * FIELD_TILE_TEXELS + uint(x & 7); }

// Old values can only be larger: most texels are spared the atomic. In tiles that are not made anew the same key stands
// already, or a smaller one.
void splatTexel(SplatRow row, SplatTriangle t, int x, vec3 framed) {
  float squared = squaredDistance(t, framed);
  if (squared > SPLAT_TEXELS * SPLAT_TEXELS) return;
  uint word = wordOf(row, x), key = keyOf(sqrt(squared) + t.extra, t.number);
  if (key < keys[word]) atomicMin(keys[word], key);
}

void splatBox(FieldCascade cascade, SplatTriangle t, ivec3 lower, ivec3 upper) {
  for (int z = lower.z; z <= upper.z; ++z)
    for (int y = lower.y; y <= upper.y; ++y) {
      SplatRow row = splatRow(cascade, y, z);
      for (int x = lower.x; x <= upper.x; ++x) splatTexel(row, t, x, inFrame(t, vec3(x, y, z) + 0.5));
    }
}
