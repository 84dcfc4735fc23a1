// Irradiance from nine coefficients (Ramamoorthi and Hanrahan 2001); twin of scene/lighting.h evaluateHarmonics.
vec3 evaluateHarmonics(vec4 coefficients[9], vec3 n) {
  return max(vec3(0.0), 0.282095 * coefficients[0].rgb + 0.488603 * (n.y * coefficients[1].rgb + n.z * coefficients[2].rgb + n.x * coefficients[3].rgb) +
         1.092548 * (n.x * n.y * coefficients[4].rgb + n.y * n.z * coefficients[5].rgb + n.x * n.z * coefficients[7].rgb) +
         0.315392 * (3.0 * n.z * n.z - 1.0) * coefficients[6].rgb + 0.546274 * (n.x * n.x - n.y * n.y) * coefficients[8].rgb);
}
