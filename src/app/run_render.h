// What `brickfield render` is asked, complete and checked as far as the command line alone allows, and the frame behind
// it. The lists that `brickfield list` prints come from the same place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/options.h"
#include "core/progress.h"

namespace brickfield {

enum class TraceChoice { Auto, Boxes };

struct RenderRequest {
  SceneRequest scene; ///< sdf nodes by sdfNodes()
  CameraRequest camera;
  LightRequest light;           ///< by makeLighting(pose, light)
  std::filesystem::path output; ///< .png or .exr, by writePicture()
  std::filesystem::path layers; ///< .exr, by writeLayers(); empty: not asked for
  std::filesystem::path stats;  ///< .json; empty: not asked for
  int frames = 1;               ///< 1/60 s apart, the last one at the scene's time; the image is the last
  TraceChoice trace = TraceChoice::Auto;
  float exposureEv = 0;
  std::string view; ///< one of viewNames(); empty: the lit picture
  int device = -1;  ///< -1: the first that works
};

/// Renders and writes everything that is asked for, the picture last.
/// error  BadInput, Failure, Cancelled; then nothing is half-written
void runRender(const RenderRequest& request);

/// A name that the command line takes, and what it means.
struct NameAndMeaning {
  std::string name;
  std::string meaning;
};
/// What --view takes.
std::vector<NameAndMeaning> viewNames();
/// The passes of a frame in their order.
std::vector<NameAndMeaning> passNames();

} // namespace brickfield
