// Which way a surface mirrors, one direction of its lobe at a time. Inner header of the reference.
#pragma once

#include "scene/brdf.h"

namespace brickfield {

struct MirroredDirection {
  glm::vec3 direction{0.0f}; ///< unit, off the surface
  glm::vec3 weight{0.0f};    ///< of the radiance that comes from there; 0 where the surface shadows itself
};

/// A direction of the specular lobe: radiance times weight has the mean that the lobe of evaluateBrdf sends back.
///
/// normal, towardsViewer  unit; a viewer below the surface (bent normals do that) counts as just above
/// square                 in [0,1)²
/// proved by tests/oracle/bakers/reference_mirror_test.cpp
MirroredDirection sampleMirrored(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer, glm::vec2 square);

} // namespace brickfield
