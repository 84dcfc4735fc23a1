// How surfaces answer light: the metallic-roughness BRDF of glTF 2.0, appendix B, and Blinn-Phong of the same
// materials, to compare with what others publish. Twin of shaders/lib/brdf.glsl; the reference shades with it. Only
// formulas: no scene, no textures. All vectors are unit and of one space.
#pragma once

#include <cstdint>

#include "core/math.h"

namespace brickfield {

/// Least perceptual roughness: alpha = 0.002. Below it the denominator of GGX at its peak, alpha^2 = 4e-6, comes within
/// some dozen roundings of single precision (6e-8) and the highlight breaks into noise.
inline constexpr float kLeastRoughness = 0.045f;

/// A material's answer to light, worked out from its parameters (appendix B.2 and B.3).
struct SurfaceBrdf {
  glm::vec3 diffuse{0.0f}; ///< c_diff: base colour, none for metals
  glm::vec3 f0{0.04f};     ///< reflectance at normal incidence: 0.04, base colour for metals
  float alpha = 1.0f;      ///< roughness squared, roughness at least kLeastRoughness
};

/// baseColor linear; metallic, roughness in [0,1]
SurfaceBrdf makeBrdf(glm::vec3 baseColor, float metallic, float roughness);

/// GGX (Trowbridge and Reitz 1975; Walter et al. 2007), per steradian. Zero below the horizon.
float distributionGgx(float alpha, float nDotH);

/// Smith masking and shadowing over 4 (N.L)(N.V), height-correlated (Heitz 2014, eq. 99), as the glTF sample viewer
/// does; appendix B's text names the separable form, which is darker by a few percent at grazing angles on rough
/// surfaces.
float visibilitySmith(float alpha, float nDotL, float nDotV);

/// Schlick 1994.
glm::vec3 fresnelSchlick(glm::vec3 f0, float vDotH);

/// The whole BRDF, without the cosine: (1 - F) c_diff / pi + F D V. Zero where the light is below the horizon; a viewer
/// below it (interpolated and mapped normals do that) counts as just above.
///
/// returns   per steradian; symmetric in two directions above the horizon
/// proved by tests/unit/scene/brdf_test.cpp
glm::vec3 evaluateBrdf(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer, glm::vec3 towardsLight);

/// Which of the two answers direct light.
enum class BrdfModel : std::uint8_t { CookTorrance, BlinnPhong };
/// "cook-torrance", "blinn-phong"
const char* brdfModelName(BrdfModel model);

/// Exponent of Blinn-Phong whose lobe is about as wide as that of GGX: 2 / alpha^2 - 2 (Walter et al. 2007, 5.2, of
/// Beckmann's).
float blinnPhongExponent(float alpha);

/// Blinn 1977, without the cosine: (1 - f0) c_diff / pi + f0 N (N.H)^s, neither masked nor brighter aside. N makes it
/// return f0, no more and no less, to a viewer who looks straight on: (s + 2) (s + 4) / (8 pi (2^(-s/2) + s)). Zero
/// where the light is below the horizon.
///
/// returns   per steradian; symmetric in two directions above the horizon
/// proved by tests/unit/scene/brdf_test.cpp
glm::vec3 evaluateBlinnPhong(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer,
                             glm::vec3 towardsLight);

/// What a white environment returns through the specular lobe is f0 * x + y (Karis, "Real Shading in Unreal Engine 4",
/// 2013), from a table that is integrated at the first call.
///
/// cost      about 50 ms at the first call, eight reads after that; safe from any number of threads
glm::vec2 environmentBrdf(float roughness, float nDotV);

/// KHR_lights_punctual: 1/d^2, windowed to end at the range (0: no end). distance > 0
float distanceFalloff(float distance, float range);

/// KHR_lights_punctual: 1 inside the inner cone, 0 outside the outer one.
float coneFalloff(float cosine, float innerConeRadians, float outerConeRadians);

} // namespace brickfield
