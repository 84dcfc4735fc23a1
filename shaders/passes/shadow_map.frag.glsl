// Depth alone; where a material has a mask, what it cuts away casts no shadow.
#include "lib/material.glsl"

layout(location = 0) in vec4 uvSets;
layout(location = 1) in float vertexAlpha;
layout(location = 2) flat in int materialRow;

void main() {
#ifdef ALPHA_MASK
  MaterialRow m = materials[materialRow];
  UvPixel uv = UvPixel(uvSets, dFdx(uvSets), dFdy(uvSets));
  float alpha = m.baseColor.a * vertexAlpha;
  if (usesTexture(m, MATERIAL_BASE_COLOR)) alpha *= MATERIAL_SAMPLE(m, MATERIAL_BASE_COLOR, uv).a;
  if (alpha < m.emission.w) discard;
#endif
}
