// glTF meshes as triangle lists with normals, and with tangents where a normal map needs them. Private to the importer.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "scene/gltf_document.h"

namespace brickfield {

/// How nodes use a mesh, as far as its vertices care.
struct MeshUse {
  bool isSkinned = false;
  std::size_t jointLimit = std::numeric_limits<std::size_t>::max(); ///< of the smallest skin
};

/// Reads scene.meshes; scene.materials must be there.
///
/// uses   one a mesh
/// error  BadInput that names mesh and primitive
void importMeshes(GltfDocument& document, const std::vector<MeshUse>& uses, Scene& scene);

} // namespace brickfield
