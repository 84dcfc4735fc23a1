// Colours of the debug views.
// Dark blue over green and yellow to red, monotonic in lightness up to yellow.
vec3 heat(float unit) {
  float x = clamp(unit, 0.0, 1.0);
  return clamp(vec3(2.5 * x - 0.75, x < 0.75 ? 1.8 * x : 4.05 - 3.6 * x, 0.35 + 0.5 * x - 2.0 * x * x), 0.0, 1.0);
}

// A hue for each node: the golden ratio keeps neighbours apart.
vec3 idColor(uint node) {
  float hue = fract(float(node) * 0.61803399 + 0.1);
  vec3 rgb = clamp(abs(fract(hue + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return mix(vec3(1.0), rgb, 0.65) * (0.7 + 0.3 * fract(float(node) * 0.38196601));
}
