// Animations as plain keys. Private to the importer.
#pragma once

#include "scene/gltf_document.h"

namespace brickfield {

/// Reads scene.animations; nodes and meshes must be there. Channels without a node (they belong to extensions) or with
/// an unknown path are left out with a warning, as are samplers whose times have no data.
/// error BadInput that names animation and channel
void importAnimations(GltfDocument& document, Scene& scene);

} // namespace brickfield
