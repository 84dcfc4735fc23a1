// Surface keys: in each texel around a triangle the smallest of (distance, number), packed in a word for atomicMin: the
// distance, quantised, in the high bits. Same triangles, same keys, in whatever order they come. Where there is no key, the
// nearest triangle that field_evaluate found stands, with the largest distance code, which no key has.
#include "lib/field_candidates.glsl"
#include "lib/field_grid.glsl"

const float SPLAT_TEXELS = 2.0; // field/field_windows.h kFieldSplatTexels
// Rank that the largest code of a key stands for: the splat radius and half a sheet.
const float KEY_RANGE_TEXELS = SPLAT_TEXELS + 0.5;

uint foundCode() { return (1u << (32u - field.counts.y)) - 1u; }
uint keyOf(float rankTexels, uint triangle) {
  uint codes = foundCode() - 1u;
  uint code = min(uint(rankTexels / KEY_RANGE_TEXELS * float(codes)), codes);
  return code << field.counts.y | triangle;
}
uint foundWordOf(uint triangle) { return triangle == FIELD_NONE ? FIELD_NONE : foundCode() << field.counts.y | triangle; }
bool isKey(uint word) { return word >> field.counts.y != foundCode(); }
// Of a key or of what was found.
uint triangleOfWord(uint word) { return word == FIELD_NONE ? FIELD_NONE : word & ((1u << field.counts.y) - 1u); }
float rankTexelsOfKey(uint key) {
  return float(key >> field.counts.y) / float(foundCode() - 1u) * KEY_RANGE_TEXELS;
}
