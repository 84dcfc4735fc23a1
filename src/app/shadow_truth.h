// What the reference says of a frame's shadows, kept in files so that it is traced once.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "scene/frame_layers.h"
#include "scene/lighting.h"
#include "scene/view.h"

namespace brickfield {

struct ShadowTruthRequest {
  const Scene& scene;
  const Pose& pose;
  const View& view;
  const Lighting& lighting; ///< a shadow layer for each of its lights
  int samples = 1024;
  int threads = 0;
  std::filesystem::path folder; ///< made if missing
  std::string name;             ///< of the file, which a hash of all that decides it follows
};

/// Layers without colour: read from the folder, or traced and written there. Nothing in a build without bakers.
/// error  BadInput: the folder cannot be written; Cancelled
std::optional<FrameLayers> shadowTruth(const ShadowTruthRequest& request);

} // namespace brickfield
