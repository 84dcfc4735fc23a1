// The hierarchy and what hangs on it: nodes, scenes, skins, cameras, lights, instances. Private to the importer.
#pragma once

#include "scene/gltf_document.h"
#include "scene/gltf_mesh.h"

namespace brickfield {

/// Reads scene.nodes, proves the hierarchy a forest (one parent each, no cycle, any depth), and scene.scenes.
/// A file without scenes shows nothing, as the specification has it: defaultScene is -1 and a warning says so. A file
/// with scenes that names no default one shows the first.
/// error BadInput that names the node
void importNodes(GltfDocument& document, Scene& scene);

/// Reads scene.skins.
void importSkins(GltfDocument& document, Scene& scene);

/// How nodes use each mesh; scene.nodes and scene.skins must be there.
std::vector<MeshUse> meshUses(const GltfDocument& document, const Scene& scene);

/// Weights of nodes fit their meshes, skins have a common root; needs everything else of the scene.
void checkNodes(const GltfDocument& document, const Scene& scene);

/// Reads scene.cameras and scene.lights.
void importCameras(GltfDocument& document, Scene& scene);
void importLights(GltfDocument& document, Scene& scene);

} // namespace brickfield
