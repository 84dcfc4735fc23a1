// Octahedral unit vectors (Meyer et al. 2010); twin of core/math.h.
vec2 octahedralFromDirection(vec3 direction) {
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 signs = vec2(d.x >= 0.0 ? 1.0 : -1.0, d.y >= 0.0 ? 1.0 : -1.0);
  return d.z >= 0.0 ? d.xy : (1.0 - abs(d.yx)) * signs;
}

vec3 directionFromOctahedral(vec2 octahedral) {
  vec3 d = vec3(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
  float fold = max(-d.z, 0.0);
  d.x += d.x >= 0.0 ? -fold : fold;
  d.y += d.y >= 0.0 ? -fold : fold;
  return normalize(d);
}
