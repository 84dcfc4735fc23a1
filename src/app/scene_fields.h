// Bakes the SDF objects of a scene: one field for each different mesh and settings, through the cache.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "bakers/bake.h"
#include "core/progress.h"
#include "resident/resident_scene.h"
#include "scene/pose.h"

namespace brickfield {

struct SceneFieldsResult {
  SceneFields fields;
  std::vector<std::string> warnings; ///< a line for each node that stays a mesh, and why, for each fault of the cache,
                                     ///< and for each field with parts too thin for its voxels
  std::size_t baked = 0;             ///< fields that were not in the cache
};

/// settingsOfNode  as sdfNodes() gives them: nothing where a node is drawn as a mesh
/// cacheFolder     empty: no cache
/// Deformed meshes are baked as they are posed. A node whose mesh has no area stays a mesh, with a warning. Fields are
/// baked several at once, those aside that might then need more memory than their settings allow.
/// returns         the same in any order of work
/// error           BadInput, Cancelled
/// proved by       tests/bake/app/scene_fields_test.cpp
SceneFieldsResult bakeSceneFields(const Scene& scene, const Pose& pose,
                                  const std::vector<std::optional<BakeSettings>>& settingsOfNode,
                                  const std::filesystem::path& cacheFolder, const Progress& progress);

/// One line on what `label` loses at this resolution, and which voxels would show it; empty where that is little.
std::string thinPartsWarning(const std::string& label, const BrickField& field, const BakeSettings& settings);

} // namespace brickfield
