// The normals of a rough surface as a viewer sees them, after Heitz 2018: what mirrored rays are drawn by. Twin of
// shaders/lib/visible_normals.glsl. In the space whose z is the surface's normal.
#pragma once

#include "core/math.h"

namespace brickfield {

/// Of the normals of a GGX lobe, weighed by how much of each a viewer sees, the one that a point stands for.
///
/// viewer  unit, z at least 0
/// square  in [0,1)²; both halves of its y are the mirror images of each other across the viewer's plane
/// source  Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018
glm::vec3 visibleNormal(float alpha, glm::vec3 viewer, glm::vec2 square);

/// Of what the viewer's normals send back to a direction, the share that the surface does not hide on its way: Smith's,
/// height-correlated, G2/G1 (Heitz 2014). Times Fresnel's it is the weight of a sample by visibleNormal.
///
/// nDotV, nDotL  above 0
float smithShadowing(float alpha, float nDotV, float nDotL);

} // namespace brickfield
