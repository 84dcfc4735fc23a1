// glTF 2.0 files (.gltf, .glb) to a Scene, through tinygltf. What tinygltf does not check is checked here.
#pragma once

#include <cstdint>
#include <filesystem>

#include "scene/scene.h"

namespace brickfield {

/// Bounds against files that are small on disk and vast in memory. Defaults admit every honest scene of a desktop.
struct ImportLimits {
  std::uint64_t fileBytes = std::uint64_t{2} << 30; ///< each file that is read
  std::uint32_t imageSidePixels = 16384;
  std::uint64_t imagePixelsTotal = std::uint64_t{256} << 20;
  std::uint64_t verticesTotal = std::uint64_t{128} << 20;
  std::uint64_t indicesTotal = std::uint64_t{512} << 20;
  int jsonDepth = 200;
};

/// Reads, validates and completes a scene.
///
/// error     BadInput that names the file and the element
/// proved by tests/unit/scene/gltf_import_test.cpp, tests/robustness/scene/hostile_gltf_test.cpp
Scene importGltf(const std::filesystem::path& path, const ImportLimits& limits = {});

} // namespace brickfield
