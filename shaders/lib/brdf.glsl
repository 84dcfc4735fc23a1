// Metallic-roughness shading as glTF 2.0 appendix B defines it, and Blinn-Phong beside it; twin of scene/brdf.h.
const float kPi = 3.14159265;

// Trowbridge and Reitz 1975 (GGX; Walter et al. 2007). Zero below the horizon, where a viewer from below puts the
// half vector.
float distributionGgx(float nDotH, float alpha) {
  if (nDotH <= 0.0) return 0.0;
  float a2 = alpha * alpha;
  float d = nDotH * nDotH * (a2 - 1.0) + 1.0;
  return a2 / (kPi * d * d);
}

// Height-correlated Smith visibility (Heitz 2014), already over 4 nDotL nDotV.
float visibilitySmith(float nDotL, float nDotV, float alpha) {
  float a2 = alpha * alpha;
  float ggxV = nDotL * sqrt(nDotV * nDotV * (1.0 - a2) + a2);
  float ggxL = nDotV * sqrt(nDotL * nDotL * (1.0 - a2) + a2);
  float sum = ggxV + ggxL;
  return sum > 0.0 ? 0.5 / sum : 0.0;
}

// Schlick 1994.
vec3 fresnelSchlick(vec3 f0, float vDotH) { return f0 + (1.0 - f0) * pow(clamp(1.0 - vDotH, 0.0, 1.0), 5.0); }

struct Surface {
  vec3 baseColor;
  float metallic;
  float roughness;
  float transmitted; // of the diffuse light, to the other side
};

// Of the diffuse light that is sent back.
vec3 diffuseColor(Surface surface) { return surface.baseColor * ((1.0 - surface.metallic) * (1.0 - surface.transmitted)); }

// Below this a highlight is narrower than a pixel and its peak leaves half floats: 0.045² as alpha, Filament's choice.
const float kLeastRoughness = 0.045;

float alphaOfRoughness(float roughness) {
  float r = max(roughness, kLeastRoughness);
  return r * r;
}

// BRDF times the cosine.
vec3 reflectedShare(Surface surface, vec3 normal, vec3 toViewer, vec3 toLight) {
  float nDotL = dot(normal, toLight);
  if (nDotL <= 0.0) return vec3(0.0);
  float nDotV = max(dot(normal, toViewer), 1e-4);
  vec3 halfway = normalize(toLight + toViewer);
  float alpha = alphaOfRoughness(surface.roughness);
  float vDotH = clamp(dot(toViewer, halfway), 0.0, 1.0);
  vec3 f0 = mix(vec3(0.04), surface.baseColor, surface.metallic);
  vec3 fresnel = fresnelSchlick(f0, vDotH);
  vec3 diffuse = (1.0 - fresnel) * diffuseColor(surface) / kPi;
  vec3 specular = fresnel * distributionGgx(min(dot(normal, halfway), 1.0), alpha) * visibilitySmith(nDotL, nDotV, alpha);
  return (diffuse + specular) * nDotL;
}

// The same of Blinn-Phong.
vec3 blinnPhongShare(Surface surface, vec3 normal, vec3 toViewer, vec3 toLight) {
  float nDotL = dot(normal, toLight);
  if (nDotL <= 0.0) return vec3(0.0);
  float alpha = alphaOfRoughness(surface.roughness), exponent = 2.0 / (alpha * alpha) - 2.0;
  float nDotH = clamp(dot(normal, normalize(toLight + toViewer)), 0.0, 1.0);
  float scale = (exponent + 2.0) * (exponent + 4.0) / (8.0 * kPi * (exp2(-0.5 * exponent) + exponent));
  float lobe = nDotH > 0.0 ? scale * pow(nDotH, exponent) : exponent > 0.0 ? 0.0 : scale;
  vec3 f0 = mix(vec3(0.04), surface.baseColor, surface.metallic);
  return ((1.0 - f0) * diffuseColor(surface) / kPi + f0 * lobe) * nDotL;
}
