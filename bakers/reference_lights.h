// Points of lights as the reference samples them. Inner header of the reference.
#pragma once

#include "scene/light_arrival.h"

namespace brickfield {

/// True where a light has a size, so that its shadows are soft.
bool hasExtent(const Light& light);

/// What one point of a light would send if the whole light shone as it does: the mean over the square is what the light
/// sends. Suns and spheres are sampled by solid angle, rectangles by area; all are of one radiance: a disk of E / (π
/// sin²) under half its angle, a sphere of I / (π r²), a rectangle of I / area on its front.
///
/// square    where on the light, in [0,1)²; nothing that has no extent looks at it
/// returns   zero irradiance from the back of a rectangle; a point within a sphere takes it as a point at its centre,
///           with nothing in the way
/// source    Shirley, Wang and Zimmerman 1996 for the cone of a sphere
/// proved by tests/oracle/bakers/area_lights_test.cpp
LightArrival sampleLight(const PosedLight& light, glm::vec3 pointWorld, glm::vec2 square);

} // namespace brickfield
