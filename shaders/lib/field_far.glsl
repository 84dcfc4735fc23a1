// Signs far from surfaces.
#include "lib/field_values.glsl"

// A coarse texel without a candidate.
const float UNKNOWN_TEXELS = 32768.0;
// How far before a surface its sign is asked for: half a texel's diagonal to and fro stays within SIGNED_TEXELS.
const float SIGN_FROM_TEXELS = 2.0;

bool isInsideFar(FieldCascade cascade, WorldTriangle t, vec3 point, TriangleHit hit) {
  float share = SIGN_FROM_TEXELS * cascade.texel.x * inversesqrt(hit.squared);
  ivec3 lattice = ivec3(floor(mix(hit.closest, point, min(share, 1.0)) * cascade.texel.y));
  bool isSure = share > SIGN_FROM_TEXELS; // nearer than a texel
  if (!isSure && isInWindow(cascade, lattice) && isBandAt(cascade, lattice)) {
    uint answer = nodes[texelWord(cascade, lattice)];
    if ((answer & SIGNED) != 0u) return ((answer & FIELD_NODE_INSIDE) != 0u) != ((answer & TURNED) != 0u);
  }
  return signedTriangleDistance(t, point, 0.0) < 0.0;
}
