// Inner header: where the texels of an equirectangular environment lie on the sphere.
#pragma once

#include "scene/lighting.h"

namespace brickfield {

/// Unit direction of a place on the image, u and v in [0,1]; inverse of environmentUv.
glm::dvec3 environmentDirection(glm::dvec2 uv);

/// u = 0.5 + atan2(x, -z) / 2π, v = acos(y) / π.
glm::vec2 environmentUv(glm::vec3 directionWorld);

/// Solid angle of each texel of a row, exact; all texels together: 4π.
double texelSolidAngle(glm::uvec2 size, std::uint32_t row);

/// Means over blocks, weighted by solid angle; sides of at most `sideLimit`, never larger than the source.
Environment shrinkEnvironment(const Environment& environment, glm::uvec2 sideLimit);

} // namespace brickfield
