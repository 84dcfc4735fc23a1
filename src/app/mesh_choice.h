// Which mesh of a scene a command means.
#pragma once

#include <string>

#include "scene/pose.h"

namespace brickfield {

/// The first instance of the node that is asked for.
///
/// node      name, or number where no node has it as a name; empty: the only node with a mesh
/// returns   refers into pose.instances
/// error     BadInput that names --node: unknown, several of that name, no mesh, not in the shown scene; without a name
///           the scene has no mesh or several, which are listed
/// proved by tests/unit/app/mesh_choice_test.cpp
const PosedInstance& chooseMesh(const Scene& scene, const Pose& pose, const std::string& node);

} // namespace brickfield
