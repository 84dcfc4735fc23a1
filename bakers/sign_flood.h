// Signs of a level: parts of space that no triangle divides have one sign, found by flooding over samples and decided
// by several inside tests each. Open meshes may change sign without a triangle between: where their rims do not rule
// that out (rims.h), cells are decided by themselves, sample by sample where it has to be (sample_signs.h).
#pragma once

#include "bakers/inside_test.h"
#include "bakers/level_sampler.h"

namespace brickfield {

struct LevelSigns {
  LargeVector<std::uint8_t> sampleInside; ///< 512 a brick
  std::vector<std::uint8_t> cellInside;   ///< a cell; of use where there is no brick
  std::vector<std::uint32_t> mixedCells; ///< ascending: cells, with and without brick, where the sign changes by itself
};

/// level     with distances to solids
/// returns   1 where inside the solids
/// proved by tests/bake/bakers/bake_field_test.cpp
LevelSigns floodSigns(const LevelSamples& level, const InsideTest& test);

} // namespace brickfield
