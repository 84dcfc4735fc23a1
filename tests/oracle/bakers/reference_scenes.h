// Small scenes, lights and views that the reference's tests share.
#pragma once

#include <numbers>

#include <gtest/gtest.h>

#include "bakers/reference.h"

namespace brickfield::test {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// A square of the plane z = 0 with corners at ±half, seen from +Z as its front.
inline Primitive squarePrimitive(float half) {
  Primitive square;
  square.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  square.normals.assign(4, {0, 0, 1});
  square.uvs[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  square.indices = {0, 1, 2, 0, 2, 3};
  square.material = 0;
  return square;
}

/// Unit sphere of latitude and longitude.
inline Primitive spherePrimitive(int rings, int segments) {
  Primitive sphere;
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment <= segments; ++segment) {
      const double polar = std::numbers::pi * ring / rings, azimuth = 2.0 * std::numbers::pi * segment / segments;
      sphere.positions.emplace_back(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                    -std::sin(polar) * std::sin(azimuth));
    }
  sphere.normals = sphere.positions;
  const auto vertex = [&](int ring, int segment) {
    return static_cast<std::uint32_t>(ring * (segments + 1) + segment);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const std::uint32_t a = vertex(ring, segment), b = vertex(ring + 1, segment), c = vertex(ring + 1, segment + 1),
                          d = vertex(ring, segment + 1);
      if (ring + 1 < rings) sphere.indices.insert(sphere.indices.end(), {a, b, c});
      if (ring > 0) sphere.indices.insert(sphere.indices.end(), {a, c, d});
    }
  sphere.material = 0;
  return sphere;
}

/// A scene with one root node for each mesh.
inline Scene sceneOf(std::vector<Primitive> primitives) {
  Scene scene;
  scene.materials.emplace_back();
  scene.materials[0].metallic = 0.0f;
  scene.scenes.emplace_back();
  for (Primitive& primitive : primitives) {
    Node node;
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back({"", {std::move(primitive)}, {}});
    scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()));
    scene.nodes.push_back(node);
  }
  return scene;
}

/// No light but a uniform environment of radiance 0.
inline Lighting darkness() {
  Lighting lighting;
  lighting.environment.size = {4, 2};
  lighting.environment.radiance.assign(8, glm::vec3(0.0f));
  return lighting;
}

inline PosedLight sunAlong(glm::vec3 direction) {
  PosedLight sun;
  sun.light.kind = LightKind::Sun;
  sun.light.intensity = kPi;
  sun.directionWorld = glm::normalize(direction);
  return sun;
}

inline View viewFrom(glm::vec3 eye, glm::vec3 target, glm::uvec2 size = {65, 65}, float nearDistance = 0.01f) {
  return makePerspectiveView(eye, target, 0.8f, nearDistance, size);
}

inline FrameLayers trace(const Scene& scene, const View& view, const Lighting& lighting, ReferenceRequest request) {
  const Pose pose = poseScene(scene, {});
  request.scene = &scene;
  request.pose = &pose;
  request.view = &view;
  request.lighting = &lighting;
  return traceReference(request);
}

inline FrameLayers trace(const Scene& scene, const View& view, const Lighting& lighting, int samples = 1,
                         int threads = 0) {
  ReferenceRequest request;
  request.samples = samples;
  request.threads = threads;
  return trace(scene, view, lighting, request);
}

inline std::size_t centreOf(const FrameLayers& layers) {
  return std::size_t{layers.size.y / 2} * layers.size.x + layers.size.x / 2;
}

inline void expectNear(glm::vec3 actual, glm::vec3 expected, float tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

} // namespace brickfield::test
