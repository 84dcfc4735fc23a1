// What a render cost and what it was asked, as JSON for --stats. Its keys are explained in src/README.md.
#pragma once

#include <nlohmann/json.hpp>

#include "app/run_render.h"
#include "renderer/renderer.h"

namespace brickfield {

struct FrameTime {
  double cpuMilliseconds = 0;   ///< posing, uploads and recording; on software rasterizers the drawing too
  std::vector<PassTime> passes; ///< at least one
  FieldStats field{};
};

/// All that is known of a finished render; pointers must not be null.
struct RenderRun {
  const RenderRequest* request = nullptr;
  const Scene* scene = nullptr;
  const Pose* pose = nullptr;         ///< of the last frame
  const Lighting* lighting = nullptr; ///< of the last frame
  const SceneFields* fields = nullptr;
  const ContextInfo* device = nullptr;
  View view; ///< of the last frame
  double loadSeconds = 0;
  double bakeSeconds = 0;        ///< with the look into the cache
  double drawSeconds = 0;        ///< upload and all frames
  std::size_t baked = 0;         ///< fields that were not in the cache
  std::vector<FrameTime> frames; ///< at least one
  FrameStats last;               ///< of a frame like the last one, with counters
};

/// Times in milliseconds where not said otherwise, sizes in bytes.
/// proved by tests/unit/app/render_stats_test.cpp
nlohmann::ordered_json renderStatsJson(const RenderRun& run);

} // namespace brickfield
