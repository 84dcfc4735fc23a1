// Signed values of coarse texels, as field_far_values leaves them; after a block of candidates.

float coarseValue(FieldCascade cascade, ivec3 coarse) {
  uint word = coarseWord(cascade, coarse);
  vec2 pair = unpackHalf2x16(candidates[coarseDistanceWord(word)]);
  return (word & 1u) == 0u ? pair.x : pair.y;
}
