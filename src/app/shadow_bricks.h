// Bricks of meshes for shadows alone: exact distances where the world field is too coarse.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.h"
#include "core/progress.h"
#include "resident/resident_scene.h"

namespace brickfield {

struct ShadowBrickRequest {
  int voxels = 1024; ///< along the scene's longest side; of a mesh its share of them, 16 to 512 or, if more, half of
                     ///< all up to 1024
  std::uint64_t memoryBytes = 0;
  int threads = 0;
  std::filesystem::path cacheFolder; ///< empty: no cache
};

/// Adds bricks, of closed surfaces as solids and of all others as thin sheets, to `fields` for every rigid mesh that is
/// no SDF object; skinned and morphed ones get none. Baked without attributes, through the cache.
///
/// returns    warnings, of the cache alone
/// error      BadInput, Cancelled
/// proved by  tests/bake/app/shadow_bricks_test.cpp
std::vector<std::string> addShadowBricks(const Scene& scene, const Pose& pose, const ShadowBrickRequest& request,
                                         SceneFields& fields, const Progress& progress);

} // namespace brickfield
