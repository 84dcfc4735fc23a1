// A scene loaded, posed and baked for tests, and the two pictures of it: the renderer's and the reference's.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bakers/bake.h"
#include "renderer/renderer.h"
#include "scene/brdf.h"
#include "scene/frame_layers.h"
#include "scene/view.h"

namespace brickfield::test {

/// A scene with what a frame of it needs. Fields come from a cache under the build folder.
class TestScene {
public:
  /// sdf         as on the command line: "all", "none", a glob; "" for what the scene's extras say
  /// resolution  of every SDF node; 0: extras or the default
  TestScene(const std::filesystem::path& path, const std::string& sdf, int resolution = 0,
            std::optional<double> seconds = {});
  /// From memory: a scene built by hand.
  TestScene(Scene built, const std::string& sdf, int resolution = 0);

  const Scene& scene() const { return *scene_; }
  const Pose& pose() const { return pose_; }
  const Lighting& lighting() const { return lighting_; }
  /// Its lights stay; the surroundings are black.
  void darkenEnvironment();
  const SceneFields& fields() const { return fields_; }
  bool isSdf(int node) const { return fields_.fieldOfNode[static_cast<std::size_t>(node)] >= 0; }

  View autoView(glm::uvec2 sizePixels) const;
  View view(glm::vec3 eye, glm::vec3 target, glm::uvec2 sizePixels, float fovDegrees = 45) const;

  /// shadows false: lit as the renderer lights, which has none
  FrameLayers reference(const View& view, bool shadows = true, BrdfModel brdf = BrdfModel::CookTorrance) const;
  /// Uploads into a renderer of its own on the current context.
  std::unique_ptr<Renderer> makeRenderer(const ContextInfo& info, const RendererSettings& settings = {}) const;
  /// One for all that draw the scene: while the shape of its world field stays, that is made once.
  Renderer& sharedRenderer(const ContextInfo& info, const RendererSettings& settings) const;

  /// Smallest and largest metres of world that a voxel of a node's field spans.
  glm::vec2 voxelWorld(int node) const;

private:
  void prepare(const std::string& sdf, int resolution, std::optional<double> seconds);

  std::unique_ptr<Scene> scene_;
  Pose pose_;
  Lighting lighting_;
  SceneFields fields_;
  mutable std::unique_ptr<Renderer> shared_;
};

/// How a picture of SDF objects differs from the reference's. Depths in the smallest voxel of the object hit.
struct Fidelity {
  double silhouetteIou = 0; ///< of "something is hit"
  double depthMedian = 0;   ///< over pixels where both hit the same node
  double depthP99 = 0;
  double normalMedianDegrees = 0;
  std::size_t bothHit = 0;
};
Fidelity measureFidelity(const TestScene& scene, const FrameLayers& frame, const FrameLayers& reference);
std::string describe(const Fidelity& fidelity);

} // namespace brickfield::test
