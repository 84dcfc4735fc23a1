// One level as band bricks alone, with the distances before they are coded: what measures of the baker look at. It is
// the same code that bakes fields, without attributes, without coarser levels.
#pragma once

#include <vector>

#include "bakers/bake.h"
#include "bakers/triangle_soup.h"

namespace brickfield {

struct BandBake {
  glm::vec3 originObject{0};       ///< sample 0
  BrickLevel level;                ///< bricks within the narrow band
  LargeVector<float> signedVoxels; ///< 512 a brick, before clamping and coding
  TriangleSoup soup;               ///< what was baked
  BakeStats stats;
};

/// settings  mips and attributes are not looked at
/// error     as bakeField
/// proved by tests/bake/bakers/band_bake_test.cpp
BandBake bakeBand(const BakeInput& input, const BakeSettings& settings, const Progress& progress = {});

} // namespace brickfield
