// What a frame cost, as JSON for --stats.
#pragma once

#include <nlohmann/json.hpp>

#include "app/run_render.h"
#include "renderer/renderer.h"

namespace brickfield {

/// Times in milliseconds, sizes in bytes; counters are those of the last frame.
nlohmann::ordered_json renderStatsJson(const RenderRequest& request, const ContextInfo& info, const FrameStats& stats);

} // namespace brickfield
