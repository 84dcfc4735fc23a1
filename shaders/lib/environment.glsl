// Equirectangular directions; twin of scene/lighting.h. u = 0.5 + atan2(x, -z) / 2π, v = acos(y) / π, row 0 is the zenith.
const float kEnvironmentPi = 3.14159265;

vec2 equirectFromDirection(vec3 direction) {
  return vec2(0.5 + atan(direction.x, -direction.z) / (2.0 * kEnvironmentPi), acos(clamp(direction.y, -1.0, 1.0)) / kEnvironmentPi);
}

vec3 directionFromEquirect(vec2 uv) {
  float phi = (uv.x - 0.5) * 2.0 * kEnvironmentPi, theta = uv.y * kEnvironmentPi;
  return vec3(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
}

// Hammersley point set (van der Corput in base 2).
vec2 hammersley(uint index, uint count) { return vec2((float(index) + 0.5) / float(count), float(bitfieldReverse(index)) * 2.3283064e-10); }

// Half vector distributed as GGX around +Z (Walter et al. 2007, eq. 35).
vec3 sampleGgx(vec2 uniformPair, float alpha) {
  float phi = 2.0 * kEnvironmentPi * uniformPair.x;
  float cosTheta = sqrt((1.0 - uniformPair.y) / (1.0 + (alpha * alpha - 1.0) * uniformPair.y));
  float sinTheta = sqrt(max(0.0, 1.0 - cosTheta * cosTheta));
  return vec3(sinTheta * cos(phi), sinTheta * sin(phi), cosTheta);
}
