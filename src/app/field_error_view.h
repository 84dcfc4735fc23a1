// The view field-error: how far the world field of the last frame is from the exact distances of the meshes, along the
// plane of the field views. Made on the CPU; not there in a build without bakers.
#pragma once

#include "app/image.h"
#include "renderer/renderer.h"

namespace brickfield {

/// Null in a build without bakers. The renderer draws it as `field`.
const DebugView* fieldErrorView();

/// Blue no error, red half a texel or more, of the cascade that answers; magenta: on the wrong side; grey: not held.
/// Where the field ends at its range or border only what it says too much is an error. Sheets count as half a texel
/// thick to each side. The truth of SDF objects is that of the meshes they were baked from: what baking costs shows
/// too. Where they reach into each other it is the least of them, the deepest.
///
/// fieldOfNode  as SceneFields has it: nodes with 0 or more are SDF objects
/// cost       a query of all closed parts a pixel
/// proved by  tests/render/field_error_view_test.cpp
RgbImage fieldErrorPicture(const FieldVolumes& field, const FieldPicture& plane, glm::uvec2 size, const Scene& scene,
                           const Pose& pose, const std::vector<int>& fieldOfNode);

} // namespace brickfield
