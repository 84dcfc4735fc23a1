// Wires importer, baker, renderer and reference as the app does.
#include "tests/support/scene_frames.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/options.h"
#include "app/scene_fields.h"
#include "bakers/reference.h"
#include "scene/gltf_import.h"

namespace brickfield::test {

TestScene::TestScene(const std::filesystem::path& path, const std::string& sdf, int resolution,
                     std::optional<double> seconds)
    : scene_(std::make_unique<Scene>(importGltf(path))) {
  prepare(sdf, resolution, seconds);
}

TestScene::TestScene(Scene built, const std::string& sdf, int resolution)
    : scene_(std::make_unique<Scene>(std::move(built))) {
  prepare(sdf, resolution, {});
}

void TestScene::prepare(const std::string& sdf, int resolution, std::optional<double> seconds) {
  PoseRequest request;
  request.seconds = seconds;
  pose_ = poseScene(*scene_, request);
  lighting_ = makeLighting(pose_, std::vector<std::string>{}, Environment{});
  SdfRequest sdfRequest;
  if (!sdf.empty()) sdfRequest.patterns = {sdf};
  if (resolution > 0) sdfRequest.resolution = resolution;
  const std::filesystem::path cache = std::filesystem::path(BRICKFIELD_BINARY_DIR) / "test-cache";
  std::filesystem::create_directories(cache);
  fields_ = bakeSceneFields(*scene_, pose_, sdfNodes(*scene_, sdfRequest, 0), cache, {}).fields;
  fields_.triplanarOfNode = triplanarNodes(*scene_, sdfRequest);
}

void TestScene::darkenEnvironment() { lighting_.environment = {{16, 8}, std::vector<glm::vec3>(128, glm::vec3(0))}; }

View TestScene::autoView(glm::uvec2 sizePixels) const {
  CameraRequest request;
  request.camera = "auto";
  request.sizePixels = sizePixels;
  return makeView(*scene_, pose_, request);
}

View TestScene::view(glm::vec3 eye, glm::vec3 target, glm::uvec2 sizePixels, float fovDegrees) const {
  CameraRequest request;
  request.eye = eye;
  request.target = target;
  request.verticalFovDegrees = fovDegrees;
  request.sizePixels = sizePixels;
  return makeView(*scene_, pose_, request);
}

FrameLayers TestScene::reference(const View& view, bool shadows, BrdfModel brdf) const {
  ReferenceRequest request;
  request.scene = scene_.get();
  request.pose = &pose_;
  request.view = &view;
  request.lighting = &lighting_;
  request.shadows = shadows;
  request.brdf = brdf;
  request.isSdf = [this](int node) { return isSdf(node); };
  return traceReference(request);
}

std::unique_ptr<Renderer> TestScene::makeRenderer(const ContextInfo& info, const RendererSettings& settings) const {
  auto renderer = std::make_unique<Renderer>(info);
  renderer->setScene(*scene_, fields_);
  renderer->setPose(pose_);
  renderer->setLighting(lighting_);
  renderer->setSettings(settings);
  return renderer;
}

Renderer& TestScene::sharedRenderer(const ContextInfo& info, const RendererSettings& settings) const {
  if (!shared_)
    shared_ = makeRenderer(info, settings);
  else
    shared_->setSettings(settings);
  return *shared_;
}

glm::vec2 TestScene::voxelWorld(int node) const {
  const int field = fields_.fieldOfNode[static_cast<std::size_t>(node)];
  const float voxel = fields_.fields[static_cast<std::size_t>(field)].levels[0].voxelSizeObject;
  for (const PosedInstance& instance : pose_.instances)
    if (instance.node == node) return voxel * scaleRange(instance.worldFromObject);
  return glm::vec2(voxel);
}

namespace {
// The value below which `share` of the values lie.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}
} // namespace

Fidelity measureFidelity(const TestScene& scene, const FrameLayers& frame, const FrameLayers& reference) {
  std::size_t either = 0, both = 0;
  std::vector<double> depths, angles;
  for (std::size_t p = 0; p < frame.kind.size(); ++p) {
    const bool a = frame.kind[p] != SurfaceKind::None, b = reference.kind[p] != SurfaceKind::None;
    either += a || b;
    both += a && b;
    if (!a || !b || frame.id[p] != reference.id[p] || !scene.isSdf(frame.id[p])) continue;
    depths.push_back(std::abs(double{frame.depth[p]} - reference.depth[p]) / scene.voxelWorld(frame.id[p]).x);
    const double cosine = glm::dot(frame.normalSurface[p], reference.normalSurface[p]);
    angles.push_back(glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
  }
  Fidelity result;
  result.silhouetteIou = either ? static_cast<double>(both) / static_cast<double>(either) : 1;
  result.bothHit = depths.size();
  result.depthMedian = quantile(depths, 0.5);
  result.depthP99 = quantile(depths, 0.99);
  result.normalMedianDegrees = quantile(angles, 0.5);
  return result;
}

std::string describe(const Fidelity& f) {
  return fmt::format("IoU {:.4f}, depth median {:.4f} p99 {:.3f} voxels, normal median {:.2f} degrees, {} pixels",
                     f.silhouetteIou, f.depthMedian, f.depthP99, f.normalMedianDegrees, f.bothHit);
}

} // namespace brickfield::test
