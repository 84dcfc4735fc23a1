// The settings of each node, then the baker of SDF objects.
#include "app/shadow_bricks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/scene_fields.h"
#include "bakers/bake.h"
#include "scene/surface_topology.h"

namespace brickfield {

namespace {

// What is as long as the scene, its walls, gets half of the voxels from 1024 on: they are flat, and most of all bricks.
constexpr int kLeastVoxels = 16, kAllVoxels = 512;

float longestSide(const Mesh& mesh, const glm::mat4& worldFromObject) {
  Box box;
  for (const Primitive& primitive : mesh.primitives)
    for (const glm::vec3& position : primitive.positions) box.extend(position);
  if (box.isEmpty()) return 0;
  const glm::vec3 extent = box.extent();
  return std::max({extent.x, extent.y, extent.z}) * scaleRange(worldFromObject).y;
}

bool isRigid(const Mesh& mesh, const PosedInstance& instance) {
  return instance.skin < 0 && mesh.morphWeights.empty() &&
         std::ranges::all_of(mesh.primitives,
                             [](const Primitive& primitive) { return primitive.morphTargets.empty(); });
}

bool isClosed(const Mesh& mesh) {
  const SurfaceTopology topology = analyseSurface(mesh);
  return std::ranges::all_of(topology.isClosedComponent, std::identity());
}

} // namespace

std::vector<std::string> addShadowBricks(const Scene& scene, const Pose& pose, const ShadowBrickRequest& request,
                                         SceneFields& fields, const Progress& progress) {
  const glm::vec3 extent = pose.boundsWorld.isEmpty() ? glm::vec3(0) : pose.boundsWorld.extent();
  const float voxel = std::max({extent.x, extent.y, extent.z}) / static_cast<float>(request.voxels);
  const int mostVoxels = std::clamp(request.voxels / 2, kAllVoxels, kMostResolution);
  std::vector<std::optional<BakeSettings>> settings(scene.nodes.size());
  for (const PosedInstance& instance : pose.instances) {
    const auto node = static_cast<std::size_t>(instance.node);
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const bool isObject = node < fields.fieldOfNode.size() && fields.fieldOfNode[node] >= 0;
    const float side = longestSide(mesh, instance.worldFromObject);
    if (isObject || settings[node] || !isRigid(mesh, instance) || !(voxel > 0) || !(side > 0)) continue;
    BakeSettings& bake = settings[node].emplace();
    bake.resolution = static_cast<int>(
        std::clamp(std::ceil(side / voxel), static_cast<float>(kLeastVoxels), static_cast<float>(mostVoxels)));
    bake.attributes = false;
    // As the world field does: what has more than small holes is a sheet, however nearly it closes, for a shelf's front
    // must stay open and a room's walls have the light on their inside.
    if (!isClosed(mesh)) bake.sign = SignMethod::TwoSided;
    bake.memoryBytes = request.memoryBytes;
    bake.threads = request.threads;
  }
  SceneFieldsResult baked = bakeSceneFields(scene, pose, settings, request.cacheFolder, progress);
  fields.fieldOfNode.resize(scene.nodes.size(), -1);
  fields.lightFieldOfNode.assign(scene.nodes.size(), -1);
  const int first = static_cast<int>(fields.fields.size());
  for (std::size_t node = 0; node < scene.nodes.size(); ++node)
    if (baked.fields.fieldOfNode[node] >= 0) fields.lightFieldOfNode[node] = first + baked.fields.fieldOfNode[node];
  for (BrickField& field : baked.fields.fields) fields.fields.push_back(std::move(field));
  std::erase_if(baked.warnings, [](const std::string& warning) { return warning.find("cache") == std::string::npos; });
  return baked.warnings;
}

} // namespace brickfield
