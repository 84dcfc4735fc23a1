// How the lights' shadows are made.
#pragma once

#include <cstdint>

namespace brickfield {

/// Shadows of the lights: marched in the world field, by shadow maps, or marched where the maps are unsure.
enum class ShadowMethod : std::uint8_t { None, Field, Maps, MapsAndField };
inline bool marchesField(ShadowMethod method) {
  return method == ShadowMethod::Field || method == ShadowMethod::MapsAndField;
}
inline bool drawsMaps(ShadowMethod method) {
  return method == ShadowMethod::Maps || method == ShadowMethod::MapsAndField;
}

/// How the world field is asked:
///   Rays      a cone, then rays over the light where it is touched; our own
///   Hard      one ray to the middle of the light
///   MinRatio  the least k d / t along it (Quilez; the thesis)
///   Coverage  the least share of the light's disk beyond a straight edge at a signed distance
///   Rtsdf     the least k d / t, triangulated, with short jittered steps (Tan and others 2022, 2.5.2)
///   Umbra     random rays over the light weighted by how near they pass (the same, 3.3)
/// The numbers are those of shaders/lib/published_shadows.glsl.
enum class ShadowEstimator : std::uint8_t { Rays, Hard, MinRatio, Coverage, Rtsdf, Umbra };

/// Of the first shared::MOST_SHADOWED_LIGHTS lights.
struct ShadowSettings {
  ShadowMethod method = ShadowMethod::None;
  ShadowEstimator estimator = ShadowEstimator::Rays;
  int penumbraRays = 16;       ///< of a point that sees a part of a light, 1 to 64; of Rays and Umbra
  float softness = 1;          ///< of the fade between rays, 0 to 4: 1 as wide as they are apart, about; of Rays
  bool nearBricks = true;      ///< bricks of objects where they have any; of Rays on the exact field
  bool halfResolution = false; ///< every fourth pixel first, what lies between from its neighbours
  float mostStep = 0.05f;      ///< of half the field's width, above 0; of Rtsdf and Umbra
  std::uint32_t seed = 1;      ///< of what is random in Rtsdf and Umbra

  bool operator==(const ShadowSettings&) const = default;
};

} // namespace brickfield
