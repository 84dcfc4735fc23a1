// Leaf cards are thinner than any field can show: they are stored as slabs a voxel thick, and seen edge on a slab is
// wider than all that is seen of its card. So slabs know which way their cards face, in a byte beside their colours,
// and where a ray meets one aslant it is asked where it crosses the card. The graphics card's twin is
// shaders/lib/card_crossing.glsl.
#pragma once

#include <cstdint>

#include "field/brick_field.h"

namespace brickfield {

/// Of axes that a card's byte can tell.
inline constexpr int kCardAxes = 127;

/// Unit, on the hemisphere of positive z, where they lie along a spiral (Vogel 1979).
///
/// number  0 to kCardAxes - 1
glm::vec3 cardAxis(int number);
/// The one nearest to a card's normal, whichever way that points: within 0.19 radians.
///
/// proved by  tests/unit/field/card_crossing_test.cpp
int nearestCardAxis(glm::vec3 normal);
/// What a sample of a card has in the last byte of BrickLevel::material.
std::uint8_t cardByte(int axisNumber, bool isUnlit);

/// Whether a ray sees what it meets: whether coverage is one half or more, of cards aslant where the ray crosses the
/// card itself, of all else where it meets the surface. True where no coverage is stored.
///
/// pointObject      metres in object space, where the ray meets the surface
/// directionObject  of the ray, not zero
/// isBack           the ray comes out of the surface there
/// proved by        tests/unit/field/card_crossing_test.cpp, tests/gpu/passes/card_crossing_test.cpp
bool isCovered(const BrickField& field, std::size_t level, glm::vec3 pointObject, glm::vec3 directionObject,
               bool isBack);

} // namespace brickfield
