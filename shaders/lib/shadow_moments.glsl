// Warped depths whose moments shadow maps are filtered by (Lauritzen and McCool 2008, exponential variance shadow maps).
// A depth between a layer's near and far end, 0 to 1, goes through two exponentials; each by itself bounds the lit share
// from above, and they fail at different places.

// exp(2 * 42) is the largest square that floats hold with room for sums; the negative side stays mild, it only trims
// what the positive one leaks.
const float kWarpPositive = 42.0, kWarpNegative = 5.0;

vec2 warpDepth(float share) {
  float z = clamp(2.0 * share - 1.0, -1.0, 1.0);
  return vec2(exp(kWarpPositive * z), -exp(-kWarpNegative * z));
}

// First and second moments of both.
vec4 momentsOf(float share) {
  vec2 w = warpDepth(share);
  return vec4(w, w * w);
}

// Chebyshev's bound on the share of depths that are not nearer than mine.
float chebyshev(vec2 moments, float mine, float leastVariance) {
  if (mine <= moments.x) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, leastVariance);
  float apart = mine - moments.x;
  return variance / (variance + apart * apart);
}

// tolerance  share of the depth range within which depths are the same surface
float litShare(vec4 moments, float share, float tolerance) {
  vec2 w = warpDepth(share);
  vec2 least = vec2(kWarpPositive, kWarpNegative) * w * 2.0 * tolerance; // by the warp's slope
  least *= least;
  return min(chebyshev(moments.xz, w.x, least.x), chebyshev(moments.yw, w.y, least.y));
}
