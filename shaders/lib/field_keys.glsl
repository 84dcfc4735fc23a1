// Surface keys: in each texel around a triangle the smallest of (distance, number), packed in a word for atomicMin: the
// distance, quantised, in the high bits. Same triangles, same keys, in whatever order they come.
#include "lib/field_candidates.glsl"
#include "lib/field_grid.glsl"

const float SPLAT_TEXELS = 2.0; // field/field_windows.h kFieldSplatTexels
// Rank that the largest code stands for: the splat radius and half a sheet.
const float KEY_RANGE_TEXELS = SPLAT_TEXELS + 0.5;

uint keyOf(float rankTexels, uint triangle) {
  uint codes = (1u << (32u - field.counts.y)) - 1u;
  uint code = min(uint(rankTexels / KEY_RANGE_TEXELS * float(codes)), codes);
  return code << field.counts.y | triangle;
}
uint triangleOfKey(uint key) { return key == FIELD_NONE ? FIELD_NONE : key & ((1u << field.counts.y) - 1u); }
float rankTexelsOfKey(uint key) {
  uint codes = (1u << (32u - field.counts.y)) - 1u;
  return float(key >> field.counts.y) / float(codes) * KEY_RANGE_TEXELS;
}
