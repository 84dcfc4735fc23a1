// What the grid of a field says of a place around it. Between grid points both are interpolated: the surface point is
// right where what is nearest is flat or a corner, and lies off the surface where it jumps from one part to another.
#include "shared/bindings.h"
#include "shared/world_field_params.h"

// rgb: surface point, parts of the field's box; a: distance, negative inside, parts of the grid's diagonal from -1 to 1
// as 0 to 1.
layout(binding = kNearestPointUnit) uniform sampler3D nearest_points;
uniform vec3 nearestPointTexel; // parts of the texture

struct NearPoint {
  vec3 surfaceGrid;
  float signedGrid; // distance, interpolated; grid voxels
  float excess;     // by which it may exceed the distance
  float outer;      // from the grid to the place
};

vec3 surfaceOfTexel(FieldObjectRow row, vec4 texel) {
  return row.boxMin.xyz + texel.rgb * (row.boxMax.xyz - row.boxMin.xyz);
}

// Cells from the grid's first point, in the grid.
vec3 inPoints(FieldObjectRow row, vec3 pointGrid) {
  return clamp((pointGrid - row.points.xyz) / row.pointCell.xyz, vec3(0.0), vec3(NEAREST_POINTS - 1u));
}

NearPoint nearPoint(FieldObjectRow row, vec3 pointGrid) {
  vec3 cells = inPoints(row, pointGrid);
  vec4 read = textureLod(nearest_points, (row.pointBlock.xyz + cells + 0.5) * nearestPointTexel, 0.0);
  NearPoint near;
  near.surfaceGrid = surfaceOfTexel(row, read);
  near.signedGrid = (2.0 * read.a - 1.0) * row.pointBlock.w;
  // A distance d curves by at most 1/d along two axes, which interpolation adds. Inside, where surfaces are equally near,
  // it bends the other way, by as much as the way to the grid points.
  float curved = row.pointCell.w / max(abs(near.signedGrid) - 0.9 * row.points.w, 0.25 * row.points.w);
  near.excess = near.signedGrid < 0.0 ? max(curved, 0.9 * row.points.w) : curved;
  vec3 place = pointGrid - row.points.xyz;
  near.outer = distance(place, clamp(place, vec3(0.0), float(NEAREST_POINTS - 1u) * row.pointCell.xyz)); // 0 within
  return near;
}

// No distance outside is less; inside none is deeper.
float leastOf(NearPoint near) {
  float least = near.signedGrid - near.excess;
  return near.outer > 0.0 ? length(vec2(max(least, 0.0), near.outer)) : least;
}

// The surface point that a corner, 0 to 7, of a place's cell of the grid names.
vec3 cornerPoint(FieldObjectRow row, vec3 pointGrid, int corner) {
  ivec3 at = min(ivec3(inPoints(row, pointGrid)), ivec3(NEAREST_POINTS - 2u));
  at += ivec3(row.pointBlock.xyz) + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
  return surfaceOfTexel(row, texelFetch(nearest_points, at, 0));
}

// Of the eight the one nearest to the place.
vec3 nearestCorner(FieldObjectRow row, vec3 pointGrid) {
  vec3 nearest = row.boxMin.xyz;
  float least = 1e30;
  for (int i = 0; i < 8; ++i) {
    vec3 surface = cornerPoint(row, pointGrid, i), way = pointGrid - surface;
    if (dot(way, way) >= least) continue;
    least = dot(way, way);
    nearest = surface;
  }
  return nearest;
}
