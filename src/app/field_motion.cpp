// A torus by its two angles, a grid by its numbers.
#include "app/field_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

namespace brickfield {

namespace {

constexpr float kTurn = 6.2831853f;

Mesh torusMesh(float radius, float tube, std::uint32_t segments, std::uint32_t sides) {
  Primitive primitive;
  for (std::uint32_t s = 0; s < segments; ++s)
    for (std::uint32_t t = 0; t < sides; ++t) {
      const float a = kTurn * static_cast<float>(s) / static_cast<float>(segments);
      const float b = kTurn * static_cast<float>(t) / static_cast<float>(sides);
      const glm::vec3 outwards(std::cos(a), 0, -std::sin(a));
      const glm::vec3 normal = outwards * std::cos(b) + glm::vec3(0, std::sin(b), 0);
      primitive.positions.push_back(outwards * radius + normal * tube);
      primitive.normals.push_back(normal);
      const auto at = [&](std::uint32_t ds, std::uint32_t dt) {
        return (s + ds) % segments * sides + (t + dt) % sides;
      };
      for (const std::uint32_t index : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)})
        primitive.indices.push_back(index);
    }
  return {"Mover", {std::move(primitive)}, {}};
}

float turnOf(int frame) { return kTurn * static_cast<float>(frame % kFramesOfTurn) / kFramesOfTurn; }

glm::vec3 onCircle(float angle) { return {std::cos(angle), 0.3f * std::sin(2 * angle), std::sin(angle)}; }

// 0 to 1; the library's distributions are not the same everywhere.
float unitOf(std::mt19937& random) { return static_cast<float>(random() >> 8) / 16777216.0f; }

} // namespace

Scene withMover(const Scene& scene, const Pose& pose) {
  const glm::vec3 extent = pose.boundsWorld.extent();
  const float size = std::max({extent.x, extent.y, extent.z}) / 12;
  Scene result = scene;
  Node node;
  node.name = "Mover";
  node.mesh = static_cast<int>(result.meshes.size());
  result.meshes.push_back(torusMesh(size * 0.35f, size * 0.15f, 75, 40));
  result.scenes[static_cast<std::size_t>(std::max(result.defaultScene, 0))].nodes.push_back(
      static_cast<int>(result.nodes.size()));
  result.nodes.push_back(std::move(node));
  return result;
}

PoseOfFrame motionOf(const Scene& withMover, const Pose& rest, FieldMotion motion) {
  const int mover = static_cast<int>(withMover.nodes.size()) - 1;
  return [rest, mover, motion](int frame) {
    Pose pose = rest;
    const glm::vec3 center = rest.boundsWorld.center(), extent = rest.boundsWorld.extent();
    const float angle = motion == FieldMotion::Nothing ? 0.0f : turnOf(frame);
    const float tremble = motion == FieldMotion::Everything && frame % 2 ? 1e-4f * extent.x : 0.0f;
    for (PosedInstance& instance : pose.instances) {
      instance.worldFromObject[3].x += tremble;
      for (glm::mat4& joint : instance.worldFromBind) joint[3].x += tremble;
      if (instance.node == mover)
        instance.worldFromObject = glm::translate(glm::mat4(1), center + 0.2f * extent * onCircle(angle));
    }
    return pose;
  };
}

MoverCrowd makeMoverCrowd(const Scene& scene, SceneFields fields, int count) {
  std::vector<int> nodeOfField(fields.fields.size(), -1);
  for (std::size_t node = 0; node < fields.fieldOfNode.size(); ++node)
    if (fields.fieldOfNode[node] >= 0)
      nodeOfField[static_cast<std::size_t>(fields.fieldOfNode[node])] = static_cast<int>(node);
  MoverCrowd crowd;
  crowd.scene = scene;
  crowd.scene.nodes.clear();
  crowd.scene.skins.clear(), crowd.scene.animations.clear();
  crowd.scene.cameras.clear(), crowd.scene.lights.clear();
  crowd.scene.scenes = {{"Movers", {}}};
  crowd.scene.defaultScene = 0;
  crowd.fields.fields = std::move(fields.fields);
  const int side = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count)) - 1e-9));
  std::mt19937 random(1);
  for (int i = 0; i < count; ++i) {
    const std::size_t field = static_cast<std::size_t>(i) % nodeOfField.size();
    Node node;
    node.name = "Mover";
    node.mesh = scene.nodes[static_cast<std::size_t>(nodeOfField[field])].mesh;
    crowd.scene.scenes[0].nodes.push_back(i);
    crowd.scene.nodes.push_back(node);
    crowd.fields.fieldOfNode.push_back(static_cast<int>(field));
    glm::vec3 jitter;
    for (int axis = 0; axis < 3; ++axis) jitter[axis] = kMoverJitter * (2 * unitOf(random) - 1);
    const glm::vec3 place(i % side, i / side % side, i / (side * side));
    crowd.centers.push_back(kMoverSpacing * (place - 0.5f * static_cast<float>(side - 1)) + jitter);
    // A mover turns around its middle: all of it is within its box's half diagonal, at most 0.87 of its longest side.
    crowd.boundsWorld.extend(crowd.centers.back() - (0.87f * kMoverSize + kMoverCircle));
    crowd.boundsWorld.extend(crowd.centers.back() + (0.87f * kMoverSize + kMoverCircle));
  }
  return crowd;
}

PoseOfFrame motionOf(const MoverCrowd& crowd) {
  return [&crowd](int frame) {
    Pose pose;
    pose.boundsWorld = crowd.boundsWorld;
    for (std::size_t i = 0; i < crowd.scene.nodes.size(); ++i) {
      const Node& node = crowd.scene.nodes[i];
      const Box& box = crowd.fields.fields[static_cast<std::size_t>(crowd.fields.fieldOfNode[i])].boundsObject;
      const glm::vec3 extent = box.extent();
      // Golden angles: neighbours are nowhere in step.
      const float phase = kTurn * std::fmod(0.618034f * static_cast<float>(i), 1.0f);
      const glm::vec3 axis = glm::normalize(glm::vec3(std::cos(phase), 1, std::sin(phase)));
      glm::mat4 worldFromObject =
          glm::translate(glm::mat4(1), crowd.centers[i] + kMoverCircle * onCircle(turnOf(frame) + phase));
      worldFromObject = glm::rotate(worldFromObject, turnOf(frame) + phase, axis);
      worldFromObject = glm::scale(worldFromObject, glm::vec3(kMoverSize / std::max({extent.x, extent.y, extent.z})));
      PosedInstance instance;
      instance.node = static_cast<int>(i);
      instance.mesh = node.mesh;
      instance.worldFromObject = glm::translate(worldFromObject, -box.center());
      instance.morphWeights = crowd.scene.meshes[static_cast<std::size_t>(node.mesh)].morphWeights;
      pose.worldFromNode.push_back(instance.worldFromObject);
      pose.instances.push_back(std::move(instance));
    }
    return pose;
  };
}

} // namespace brickfield
