// ACES-like filmic curve (Narkowicz 2015) and the sRGB transfer function; twins of app/tone_curve.h and core/math.h.
vec3 filmicCurve(vec3 exposed) {
  vec3 x = min(exposed, 1e4); // white long since; squares of more may be infinite, and their quotient nothing
  return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 srgbFromLinear(vec3 linear) {
  return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}
