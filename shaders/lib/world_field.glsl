// The world field for whoever wants distances in the world: shadows, occlusion, views of it. Points are anchored: metres
// from the field's anchor, which is near the eye (pointEye + frame.eyeAnchored.xyz), so that floats stay fine anywhere.
// Twin: src/field/field_volume.h.
//
//   cascade 0 |--------|             the finest that holds a point answers; where its range or its border may have cut
//   cascade 1 |----------------|     the value off, the larger of it and the next coarser one's
#include "lib/field_grid.glsl"

layout(binding = kWorldFieldUnit) uniform sampler3D worldField[MOST_CASCADES];

struct FieldReading {
  float distanceWorld; // metres, negative inside
  int cascade;         // whose texels are the scale of what was read; -1: the point is outside all of them
};

vec3 fieldExtent(int cascade) { return field.cascades[cascade].extent.xyz; }

// Texels, interpolated; the volume repeats, so a lattice point is its own place in it. Samplers of an array may only be
// chosen by numbers that are the same for all threads; hence the cases.
float fieldTexels(int cascade, vec3 lattice) {
  vec3 uv = lattice / fieldExtent(cascade);
  switch (cascade) {
    case 0: return textureLod(worldField[0], uv, 0.0).r;
    case 1: return textureLod(worldField[1], uv, 0.0).r;
    case 2: return textureLod(worldField[2], uv, 0.0).r;
    case 3: return textureLod(worldField[3], uv, 0.0).r;
    case 4: return textureLod(worldField[4], uv, 0.0).r;
    case 5: return textureLod(worldField[5], uv, 0.0).r;
    case 6: return textureLod(worldField[6], uv, 0.0).r;
    default: return textureLod(worldField[7], uv, 0.0).r;
  }
}

// From the nearest side of the window, texels; from 0.5 on the eight texels around the point are all held.
float fieldDepth(int cascade, vec3 lattice) {
  vec3 inWindow = lattice - vec3(field.cascades[cascade].window.xyz);
  vec3 nearest = min(inWindow, fieldExtent(cascade) - inWindow);
  return min(nearest.x, min(nearest.y, nearest.z));
}
bool isHeldByField(float depth) { return depth >= 0.5; }

// Values end at the range and, but for a window that holds everything, at the distance to the border. A texel less than
// that for the interpolation, at the border of two axes half a one more.
bool isFieldCut(FieldCascade cascade, float texels, float depth) {
  bool isWhole = (cascade.buffers.w & FIELD_WHOLE) != 0u;
  return abs(texels) > cascade.texel.z - 1.0 || (!isWhole && texels > depth - 1.5);
}

// Outside all windows: what the coarsest one holds is at least as far as the diagonal of two legs, one to the window
// and one from there, because the window is convex.
float fieldDistanceOutside(vec3 pointAnchored) {
  int last = int(field.counts.x) - 1;
  FieldCascade cascade = field.cascades[last];
  vec3 lattice = pointAnchored * cascade.texel.y;
  vec3 first = vec3(cascade.window.xyz) + 0.5;
  vec3 nearest = clamp(lattice, first, first + fieldExtent(last) - 1.0);
  return length(vec2(max(fieldTexels(last, nearest), 0.0), distance(lattice, nearest))) * cascade.texel.x;
}

FieldReading readWorldField(vec3 pointAnchored) {
  FieldReading reading = FieldReading(0.0, -1);
  for (int c = 0; c < int(field.counts.x); ++c) {
    FieldCascade cascade = field.cascades[c];
    vec3 lattice = pointAnchored * cascade.texel.y;
    float depth = fieldDepth(c, lattice);
    if (!isHeldByField(depth)) continue;
    float texels = fieldTexels(c, lattice), metres = texels * cascade.texel.x;
    if (reading.cascade < 0)
      reading = FieldReading(metres, c);
    else
      reading.distanceWorld =
          reading.distanceWorld < 0.0 ? min(reading.distanceWorld, metres) : max(reading.distanceWorld, metres);
    if (!isFieldCut(cascade, texels, depth)) break;
  }
  if (reading.cascade < 0) reading.distanceWorld = fieldDistanceOutside(pointAnchored);
  return reading;
}

// Metres, negative inside; never above the truth by more than the field's own error. Outside all windows a lower bound
// of the distance to what they hold.
float fieldDistanceWorld(vec3 pointAnchored) { return readWorldField(pointAnchored).distanceWorld; }

// Metres a metre: of length one near surfaces, shorter where the field is cut off. Central differences over a texel of
// the cascade that answers.
vec3 fieldGradient(vec3 pointAnchored) {
  int answering = readWorldField(pointAnchored).cascade;
  float h = 0.5 * field.cascades[answering < 0 ? int(field.counts.x) - 1 : answering].texel.x;
  vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    vec3 offset = vec3(axis == 0, axis == 1, axis == 2) * h;
    gradient[axis] = fieldDistanceWorld(pointAnchored + offset) - fieldDistanceWorld(pointAnchored - offset);
  }
  return gradient / (2.0 * h);
}
