// Which part of its lobe a pixel traces. Sixteen pixels, four by four, trace a sixteenth each, and each then takes the
// mean over those around it. Where a surface is smooth there is no lobe: pixels trace its middle, and take no mean. Where
// it bends, neighbours mirror elsewhere than its lobe reaches: there parts are wider and lie nearer to the middle, down to
// half as far, and neighbours weigh less.
const float KEEN_ROUGHNESS = 0.05, SHARED_ROUGHNESS = 0.25;
const int SHARERS = 4; // along an axis

// Half of the half vectors of a GGX lobe lie within the angle whose tangent is alpha (Walter et al. 2007, eq. 35), so
// half of what a surface mirrors comes from within twice that.
float spreadOfRoughness(float roughness) {
  float alpha = roughness * roughness;
  return min(2.0 * alpha / max(1.0 - alpha * alpha, 1e-3), 1.0);
}

// The other way round, for narrow ones.
float roughnessOfSpread(float spread) { return sqrt(0.5 * spread); }

// How far pixels share: 0 not at all, 1 wholly.
//
// turn  of the mirrored direction from a traced pixel to the next
float lobeShare(float roughness, float turn) {
  float rough = clamp((roughness - KEEN_ROUGHNESS) / (SHARED_ROUGHNESS - KEEN_ROUGHNESS), 0.0, 1.0);
  float reached = spreadOfRoughness(roughness) / max(float(SHARERS / 2) * turn, 1e-6);
  return rough * clamp(reached - 0.5, 0.5, 1.0);
}

// Weight of a traced pixel some steps away, over which all sixteen parts weigh the same where the share is 1.
float sharedWeight(ivec2 steps, float share) {
  vec2 weight = vec2(1.0);
  for (int axis = 0; axis < 2; ++axis)
    if (steps[axis] != 0) weight[axis] = share * (abs(steps[axis]) < SHARERS / 2 ? 1.0 : 0.5);
  return weight.x * weight.y;
}
