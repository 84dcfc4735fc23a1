// A light as a point sees it: an axis to its middle and two half axes, in metres a metre of the way, that span its disk
// or its rectangle.
//
//        up
//    +---^---+
//    |   |   |        from p after t metres: p + t (axis + x right + y up), |x|, |y| <= 1
//    |   o-->| right
//    +-------+
//         \ axis
//          p
#include "lib/world_field.glsl"

struct ShadowCone {
  vec3 origin; // anchored; on the surface
  vec3 normal; // of the surface, unit
  vec3 axis;   // to the middle of the light, unit
  vec3 right;
  vec3 up;
  bool isRectangle;
  float spread; // radius a metre of the disk, or of one around the rectangle
  float end;    // metres: the light is there, or the field ends
  float lightAt; // metres: the light is there; 3.4e38 for suns
  float grain;  // metres, of what is read at the origin; by who marches
  float lift;   // metres, off the surface, where the march begins; by who marches
  float pixel;  // metres that a pixel spans at the origin, at most
};

// Metres.
float texelOf(FieldReading reading) {
  return field.cascades[reading.cascade < 0 ? int(field.counts.x) - 1 : reading.cascade].texel.x;
}

// Of the finest cascade around a point.
float texelAt(vec3 pointAnchored) {
  int last = int(field.counts.x) - 1, c = 0;
  while (c < last && !isHeldByField(fieldDepth(c, pointAnchored * field.cascades[c].texel.y))) ++c;
  return field.cascades[c].texel.x;
}

// Two unit vectors across an axis.
void axesAcross(vec3 axis, out vec3 right, out vec3 up) {
  right = normalize(abs(axis.y) < 0.9 ? vec3(axis.z, 0.0, -axis.x) : vec3(0.0, -axis.z, axis.y));
  up = cross(right, axis);
}

// Where a light's i-th part of `count` equal ones is, in units of the half axes: Vogel's spiral over the disk, a lattice
// by the golden ratio's plastic cousin over the rectangle (Roberts 2018). The cells of a square of two by two pixels have
// other places in the parts, so that together they have four times as many.
//
// cell  0 to 3; of one alone any
vec2 partOfLight(ShadowCone cone, int i, int count, int cell) {
  if (count == 1) return vec2(0.0);
  if (cone.isRectangle) return 2.0 * fract(0.5 + float(cell * count + i + 1) * vec2(0.7548776662, 0.5698402910)) - 1.0;
  float radius = sqrt((float(i) + 0.25 * float(cell) + 0.125) / float(count)), angle = 2.39996323 * float(i) + 1.57079633 * float(cell);
  return radius * vec2(cos(angle), sin(angle));
}

vec2 partOfLight(ShadowCone cone, int i, int count) {
  if (count == 1 || cone.isRectangle) return partOfLight(cone, i, count, 0);
  float radius = sqrt((float(i) + 0.5) / float(count)), angle = 2.39996323 * float(i);
  return radius * vec2(cos(angle), sin(angle));
}

// Beyond the field nothing blocks: where all of a cone has left the box of the coarsest window, whatever leaves later than
// its axis too.
float leavesField(vec3 origin, vec3 axis, float spread) {
  FieldCascade coarsest = field.cascades[int(field.counts.x) - 1];
  vec3 low = vec3(coarsest.window.xyz) * coarsest.texel.x, high = low + float(coarsest.window.w) * coarsest.texel.x;
  vec3 ends = (mix(low, high, greaterThan(axis, vec3(0.0))) - origin) * sign(axis), pace = abs(axis) - spread;
  vec3 far = mix(ends / pace, vec3(3.4e38), lessThan(pace, vec3(1e-7)));
  return max(min(far.x, min(far.y, far.z)), 0.0);
}
