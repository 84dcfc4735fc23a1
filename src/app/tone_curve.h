// From scene radiance to the display: exposure, tone curve, sRGB. The CPU twin of the frame's tone pass, so that a
// reference and a render compare as pictures.
#pragma once

#include "core/math.h"

namespace brickfield {

/// Display value of linear radiance.
///
/// exposureEv stops: radiance is scaled by 2^EV
/// returns    sRGB-coded, each component in [0,1]; NaN gives 0, infinity 1
/// source     curve of Narkowicz, "ACES filmic tone mapping curve", 2015; sRGB of IEC 61966-2-1
/// proved by  tests/unit/app/tone_curve_test.cpp
glm::vec3 displayFromRadiance(glm::vec3 radiance, float exposureEv);

/// The curve alone, on exposed radiance: linear display value in [0,1].
float toneCurve(float exposed);

} // namespace brickfield
