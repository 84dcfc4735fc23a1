// Nodes that share mesh, pose and settings share a field: the content hash of the bake tells.
#include "app/scene_fields.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {
bool hasArea(const BakeInput& input) {
  for (std::size_t p = 0; p < input.primitives.size(); ++p) {
    const auto& indices = input.primitives[p]->indices;
    const auto& positions = input.positionsObject[p];
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const glm::vec3 a = positions[indices[i]], b = positions[indices[i + 1]], c = positions[indices[i + 2]];
      if (glm::cross(b - a, c - a) != glm::vec3(0)) return true;
    }
  }
  return false;
}
} // namespace

std::string thinPartsWarning(const std::string& label, const BrickField& field, const BakeSettings& settings) {
  const ThinParts& thin = field.thinParts;
  if (thin.resolution == 0) return {};
  const double voxelMetres = field.levels.front().voxelSizeObject;
  const std::string remedy = thin.resolution <= kMostResolution
                                 ? fmt::format("(--resolution {})", thin.resolution)
                                 : fmt::format("(more than --resolution {})", kMostResolution);
  return fmt::format("{}: {:.0f} % of its closed surface bounds parts thinner than a voxel of {:.2g} m, which {}; "
                     "voxels of {:.2g} m would do {}",
                     label, 100.0 * thin.perTenThousand / ThinParts::kWhole, voxelMetres,
                     settings.sign == SignMethod::Auto ? "are drawn thicker" : "may have holes",
                     voxelMetres * settings.resolution / thin.resolution, remedy);
}

SceneFieldsResult bakeSceneFields(const Scene& scene, const Pose& pose,
                                  const std::vector<std::optional<BakeSettings>>& settingsOfNode,
                                  const std::filesystem::path& cacheFolder, const Progress& progress) {
  SceneFieldsResult result;
  result.fields.fieldOfNode.assign(scene.nodes.size(), -1);
  std::vector<bool> done(scene.nodes.size(), false);
  std::map<Hash128, int> fieldOfHash;
  for (const PosedInstance& instance : pose.instances) {
    const std::size_t node = static_cast<std::size_t>(instance.node);
    if (done[node] || !settingsOfNode[node]) continue;
    done[node] = true;
    const BakeInput input = bakeInputOf(scene, instance, pose);
    if (glm::determinant(glm::mat3(instance.worldFromObject)) == 0.0f) {
      result.warnings.push_back(nodeLabel(scene, instance.node) + ": its transform flattens space, so it stays a mesh");
      continue;
    }
    if (!hasArea(input)) {
      result.warnings.push_back(nodeLabel(scene, instance.node) + ": its mesh has no area, so it stays a mesh");
      continue;
    }
    const auto [entry, isNew] =
        fieldOfHash.try_emplace(bakeHash(input, *settingsOfNode[node]), static_cast<int>(result.fields.fields.size()));
    if (isNew) {
      bool wasCached = false;
      BakeResult baked = bakeCached(input, *settingsOfNode[node], cacheFolder, progress, &wasCached);
      // A folder without room for a cache says so for every field; once is enough.
      auto& warnings = result.warnings;
      if (!baked.cacheWarning.empty() &&
          std::find(warnings.begin(), warnings.end(), baked.cacheWarning) == warnings.end())
        warnings.push_back(std::move(baked.cacheWarning));
      if (std::string warning = thinPartsWarning(input.label, baked.field, *settingsOfNode[node]); !warning.empty())
        warnings.push_back(std::move(warning));
      result.fields.fields.push_back(std::move(baked.field));
      if (!wasCached) ++result.baked;
    }
    result.fields.fieldOfNode[node] = entry->second;
  }
  return result;
}

} // namespace brickfield
