// `brickfield bench shadows`: errors against the traced truth, reads and times of every way to shadows, for suns and a
// sphere light, as a table, JSON and a plate of pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"

namespace brickfield {

struct ShadowBenchRequest {
  SceneRequest scene;                      ///< the first; its settings are those of all
  std::vector<std::filesystem::path> more; ///< scenes
  CameraRequest camera{.camera = {}, .eye = {}, .target = {}, .verticalFovDegrees = {}, .sizePixels = {640, 360}};
  bool hasFloor = false;            ///< one is put under each scene
  std::vector<std::string> methods; ///< of benchedShadows(); empty: all
  std::vector<double> sunDegrees{0.5, 2, 8};
  std::optional<glm::vec3> sunTravels;  ///< nothing: as the scene's own sun, else from the upper left
  std::optional<glm::vec3> sphereWorld; ///< nothing: at four fifths of the scene's height, over its middle
  float sphereRadius = 0.2f;            ///< metres; 0: no sphere light
  std::string fieldSize = "M";
  int brickVoxels = 1024; ///< along a scene's longest side, of meshes' bricks for the methods that ask for them
  int samples = 1024;     ///< of the truth, a pixel and light
  std::filesystem::path truthFolder; ///< where truths are kept; empty: beside the user's bricks
  int frames = 10;                   ///< that are timed
  std::filesystem::path json;        ///< empty: not asked for
  std::filesystem::path plates;      ///< folder of a picture for each scene; empty: not asked for
  int device = -1;
};

/// Measures, prints, writes. Each error is of pixels whose surface is the truth's and faces the light.
/// error  BadInput, Failure, Cancelled
void runShadowBench(const ShadowBenchRequest& request);

} // namespace brickfield
