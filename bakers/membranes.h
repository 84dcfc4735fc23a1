// Membranes: where the sign of an open mesh changes although no triangle is there, as across the hole of a bunny's
// base. Left alone, the field would jump there from plus to minus. A membrane is treated as surface: its cells become
// bricks, the distances near it are taken to it, and the bounds of other cells are cut to it.
#pragma once

#include "bakers/inside_test.h"
#include "bakers/level_sampler.h"
#include "bakers/sign_flood.h"

namespace brickfield {

/// Changes samples and signs in and around signs.mixedCells; nothing where there are none.
///
/// Distances to a membrane are estimates from the slope of the winding number: right to first order near it.
/// proved by tests/bake/bakers/bake_open_test.cpp
void insertMembranes(const SamplingRequest& request, const InsideTest& test, LevelSamples& level, LevelSigns& signs);

} // namespace brickfield
