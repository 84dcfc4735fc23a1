// What nodes look like from far away: their materials averaged over their surfaces.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/node_look_params.h"

namespace brickfield {

/// One a node; of those without a mesh grey and rough. Means by area of what factors, textures and vertex colours say
/// at the middle of triangles, of a few thousand of each primitive at most. Unlit ones emit their colour.
///
/// proved by tests/oracle/passes/field_reflection_test.cpp
std::vector<shared::NodeLook> nodeLooksOf(const Scene& scene);

} // namespace brickfield
