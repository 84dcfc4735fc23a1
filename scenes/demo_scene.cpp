// The demo: a still life on podiums. Composition only; what each thing looks like is in the still_life files.
#include "scenes/scenes.h"
#include "scenes/still_life.h"

namespace brickfield::scenes {
namespace {

constexpr float kFovDegrees = 30.0f; // 35 mm stills on a 19 mm high frame, cropped a little

void addCamera(StillLife& scene, const std::string& name, glm::vec3 eye, glm::vec3 target, float fovDegrees) {
  NodeSpec node{.name = name, .translation = eye, .rotation = lookRotation(eye, target)};
  node.camera = scene.glb.addCamera(name, glm::radians(fovDegrees), 0.05f);
  scene.glb.addNode(node);
}

} // namespace

nlohmann::ordered_json sdfExtras(int resolution) { return {{"sdf", true}, {"resolution", resolution}}; }

ChannelSpec spinChannel(int node, glm::quat rest, glm::vec3 axis, float secondsPerTurn) {
  ChannelSpec channel{node, "rotation", {}, {}};
  // Quarter turns: slerp takes the shorter way, so a key at a half turn would be ambiguous.
  for (int quarter = 0; quarter <= 4; ++quarter) {
    glm::quat rotation = rest * rotationAbout(axis, 90.0f * static_cast<float>(quarter));
    channel.seconds.push_back(secondsPerTurn * 0.25f * static_cast<float>(quarter));
    channel.values.insert(channel.values.end(), {rotation.x, rotation.y, rotation.z, rotation.w});
  }
  return channel;
}

void addCamerasAndLights(StillLife& scene) {
  addCamera(scene, "main", {2.3f, 2.75f, 8.7f}, {0.02f, 0.98f, 0.0f}, kFovDegrees);
  addCamera(scene, "close", {1.7f, 1.65f, 4.4f}, {-0.1f, 0.72f, 0.1f}, kFovDegrees);
  addCamera(scene, "ball", {-0.4f, 2.3f, 2.6f}, {-1.95f, 1.2f, -0.9f}, kFovDegrees);

  // A sun of 3 lux leaves a white wall a little under 1 at exposure 0 (π lux gives 1.0).
  glm::vec3 sunFrom(-4.2f, 6.5f, 5.2f);
  NodeSpec sun{.name = "Sun", .translation = sunFrom, .rotation = lookRotation(sunFrom, {0, 0, 0})};
  sun.light = scene.glb.addLight(
      {{"name", "Sun"}, {"type", "directional"}, {"color", {1.0f, 0.93f, 0.83f}}, {"intensity", 3.0f}});
  scene.glb.addNode(sun);

  glm::vec3 spotFrom(4.6f, 4.4f, 3.4f);
  NodeSpec spot{.name = "Key", .translation = spotFrom, .rotation = lookRotation(spotFrom, {0.3f, 0.6f, 0})};
  spot.light = scene.glb.addLight({{"name", "Key"},
                                   {"type", "spot"},
                                   {"color", {0.72f, 0.86f, 1.0f}},
                                   {"intensity", 18.0f},
                                   {"spot", {{"innerConeAngle", 0.25f}, {"outerConeAngle", 0.6f}}}});
  scene.glb.addNode(spot);
}

std::vector<std::byte> demoScene() {
  StillLife scene;
  addSharedMaterials(scene);
  addTeapots(scene);
  addSculptures(scene);
  addTableware(scene);
  addSpheres(scene);
  addBooksAndLamp(scene);
  addFlowers(scene);
  addRoom(scene);
  addCamerasAndLights(scene);
  scene.glb.addAnimation("Turn and sway", scene.channels);
  return scene.glb.finish();
}

} // namespace brickfield::scenes
