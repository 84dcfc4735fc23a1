// Tests by bits: compilers may turn comparisons round, as if there were no NaN.
bool isFinite(vec3 v) {
  uvec3 exponents = floatBitsToUint(v) & 0x7f800000u;
  return all(notEqual(exponents, uvec3(0x7f800000u)));
}

// At least 0, and neither infinite nor NaN.
bool isFiniteDistance(float value) {
  uint bits = floatBitsToUint(value);
  return bits < 0x7f800000u || bits == 0x80000000u;
}
