// How far the cells of a level are from the surface, before any sample is measured: which of them may become bricks,
// and what the empty ones store.
#pragma once

#include "bakers/level_sampler.h"

namespace brickfield {

/// Fills level.cellBounds and level.cellInSheet.
///
/// level     its grid is looked at
/// cost      two to six distances a cell; where few triangles come into question, those of 8^3 cells at once. All
///           threads, the same result on any number
/// proved by tests/bake/bakers/cell_bounds_test.cpp
void boundCells(const SamplingRequest& request, LevelSamples& level);

} // namespace brickfield
