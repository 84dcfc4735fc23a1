// Inner header of pose and deform: positions alone, which is all that bounds need.
#pragma once

#include <vector>

#include "scene/pose.h"

namespace brickfield {

/// Positions after morphing and skinning; the same numbers as deformPrimitive's.
std::vector<glm::vec3> deformPositions(const Primitive& primitive, const PosedInstance& instance);

} // namespace brickfield
