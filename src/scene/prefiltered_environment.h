// The environment as surfaces of some roughness mirror it: convolved with the GGX lobe at a few roughnesses (Karis,
// "Real Shading in Unreal Engine 4", 2013, the first of the two sums; environmentBrdf is the second). The lobe is taken
// as seen from straight above, so that reflections do not stretch at grazing angles.
#pragma once

#include <vector>

#include "scene/lighting.h"

namespace brickfield {

struct PrefilteredEnvironment {
  /// levels[i] belongs to perceptual roughness i / (levels.size() - 1); the first is the environment itself.
  std::vector<Environment> levels;
};

/// cost      about 0.2 s for a large environment, single-threaded
/// proved by tests/unit/scene/lighting_test.cpp
PrefilteredEnvironment prefilterEnvironment(const Environment& environment);

/// Radiance mirrored towards a viewer whose reflected direction is given; linear between levels.
glm::vec3 samplePrefiltered(const PrefilteredEnvironment& environment, glm::vec3 directionWorld, float roughness);

} // namespace brickfield
