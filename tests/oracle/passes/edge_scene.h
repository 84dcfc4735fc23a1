// A slab over a floor, whose edge rises from 0.2 to 1.1 m: what its shadow must be is known in closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {

// The slab's edge runs along z at x = 0; the slab lies on the side of -x.
inline constexpr float kHalfThick = 0.02f, kSlope = 0.375f, kMiddle = 0.65f;

inline double heightAt(double z, bool ofTop) {
  const double thick = kHalfThick * std::sqrt(1 + double{kSlope} * kSlope);
  return kMiddle + kSlope * z + (ofTop ? thick : -thick);
}

inline Scene slabOverFloor() {
  Scene scene;
  scene.scenes.push_back({"scene", {0, 1}});
  Node floor;
  floor.name = "Floor";
  floor.mesh = 0;
  floor.matrix = glm::translate(glm::mat4(1), {0, -0.1f, 0});
  Node slab;
  slab.name = "Slab";
  slab.mesh = 1;
  slab.matrix = glm::rotate(glm::translate(glm::mat4(1), {-0.6f, kMiddle, 0}), -std::atan(kSlope), {1, 0, 0});
  scene.nodes = {floor, slab};
  scene.meshes = {makeBoxMesh({1.2f, 0.1f, 1.2f}), makeBoxMesh({0.6f, kHalfThick, 1.4f})};
  return scene;
}

inline View viewOfEdge(const TestScene& scene, glm::uvec2 size) {
  return scene.view({1.9f, 0.55f, 0}, {0, 0, 0}, size, 70);
}

// Of a disk of radius 1 that is cut at s, the part below s.
inline double shareBelow(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 0.5 + (s * std::sqrt(1 - s * s) + std::asin(s)) / std::numbers::pi;
}

// Straight down, of a disk of so many degrees.
inline Lighting overheadSun(const TestScene& scene, double degrees) {
  return makeLighting(scene.pose(), {"sun:0,-1,0:" + std::to_string(degrees) + ":3.14159265"},
                      {{1, 1}, {glm::vec3(0)}});
}

struct FloorSample {
  double x, z, visible;
};

// What is seen of the light at each pixel of the floor.
inline std::vector<FloorSample> floorSamples(const View& view, const FrameLayers& frame) {
  std::vector<FloorSample> samples;
  for (std::uint32_t y = 0; y < frame.size.y; ++y)
    for (std::uint32_t x = 0; x < frame.size.x; ++x) {
      const std::size_t i = std::size_t{y} * frame.size.x + x;
      if (frame.id[i] != 0 || frame.kind[i] == SurfaceKind::None) continue;
      const PrimaryRay ray = primaryRay(view, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      const glm::vec3 point = ray.originWorld + frame.depth[i] * ray.directionWorld;
      if (std::abs(point.y) > 1e-3f || std::abs(point.z) > 1.1f) continue;
      samples.push_back({point.x, point.z, frame.shadow.front()[i]});
    }
  return samples;
}

} // namespace brickfield::test
