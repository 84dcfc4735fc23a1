// A material on a surface without texture coordinates: its textures projected along the three axes of object space and
// blended by the normal (thesis 8.2.10). Twin of shaders/lib/triplanar.glsl; the reference looks SDF objects up by it.
#pragma once

#include "scene/texture_sampling.h"

namespace brickfield {

struct TriplanarPoint {
  glm::vec3 pointObject{0.0f};
  glm::vec3 normalObject{0.0f, 1.0f, 0.0f};                             ///< unit
  std::array<glm::vec3, 2> footprintObject{glm::vec3(0), glm::vec3(0)}; ///< its two sides, metres; zero: no filtering
};

struct TriplanarSample {
  MaterialSample material;      ///< its normalTangent says nothing
  glm::vec3 normalObject{0.0f}; ///< bent by the normal map, unit
};

/// Textures stand upright on each side of an object for who looks at it from outside, +Y up (from above -Z, from below
/// +Z), unmirrored and with a corner at the origin. Sides are weighted by the fourth power of the normal's part.
///
/// metres     of object space that a texture spans, above 0; texture transforms come on top
/// proved by  tests/render/triplanar_test.cpp
TriplanarSample sampleTriplanar(const TextureSampler& sampler, const Material& material, const TriplanarPoint& at,
                                float metres);

} // namespace brickfield
