// The import as a list: each step checks what it reads and may rely on the steps before it.
#include "scene/gltf_import.h"

#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "core/error.h"
#include "core/files.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_animation.h"
#include "scene/gltf_document.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_node.h"

namespace brickfield {

Scene importGltfBytes(std::vector<std::byte> bytes, const std::string& file, const std::filesystem::path& folder,
                      const ImportLimits& limits) {
  try {
    GltfDocument document = openGltf(std::move(bytes), file, folder, limits);
    Scene scene;
    scene.name = file;
    checkAccessors(document);
    importCameras(document, scene);
    importLights(document, scene);
    importNodes(document, scene);
    importSkins(document, scene);
    importMaterials(document, scene); // before meshes: they ask which normal maps are used
    importMeshes(document, meshUses(document, scene), scene);
    checkNodes(document, scene);
    importAnimations(document, scene);
    importImages(document, scene); // last: the most costly step
    scene.warnings = std::move(document.warnings);
    scene.files = std::move(document.files);
    return scene;
  } catch (const std::bad_alloc&) {
    throw BadInput(file, "", "needs more memory than there is");
  } catch (const std::length_error&) {
    throw BadInput(file, "", "needs more memory than there is");
  }
}

Scene importGltf(const std::filesystem::path& path, const ImportLimits& limits) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  return importGltfBytes(readFile(path, limits.fileBytes), path.string(), folder, limits);
}

} // namespace brickfield
