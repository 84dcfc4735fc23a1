// What a frame can be asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "passes/frame_context.h"

namespace brickfield {

struct RendererSettings {
  float exposureEv = 0;               ///< stops; at 0 a white diffuse surface under π lux has radiance 1
  std::uint32_t maxTraceSteps = 2048; ///< of a ray in one object; running out is a miss and is counted
  int forcedLevel = -1;               ///< level that all SDF objects show; -1: by the size of a voxel on screen
  DrawOrder drawOrder = DrawOrder::MeshesFirst;
  bool countersOn = false; ///< counts fragments, steps and brick reads; slower
  std::string view;        ///< one of debugViews(); empty: the lit picture
};

/// A picture of one layer, as `--view` and `list views` name it.
struct DebugView {
  std::string name;
  std::string meaning;
  std::uint32_t number; ///< DEBUG_VIEW_*
  float redAt = 0;      ///< count that is shown as the heat scale's end; 0: no counts
};
const std::vector<DebugView>& debugViews();

} // namespace brickfield
