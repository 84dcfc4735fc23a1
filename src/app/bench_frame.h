// `brickfield bench frame`: what a whole frame takes, pass by pass, and what is read for a pixel of it, for any scene
// and settings that render takes.
#pragma once

#include <filesystem>

#include "app/run_render.h"

namespace brickfield {

inline constexpr int kBenchedFrames = 60;

struct FrameBenchRequest {
  RenderRequest render;       ///< without outputs; its frames are those that are timed
  bool besideThesis = false;  ///< prints the thesis' figures beside, of as many objects as the scene has
  std::filesystem::path json; ///< empty: not asked for
};

/// Settles the request, draws, prints, writes. Frames that move are warmed up by the first of them.
/// error  BadInput, also where the thesis has no figures of as many objects; Failure, Cancelled
void runFrameBench(FrameBenchRequest request);

} // namespace brickfield
