// The frame's textures as layers on the CPU. GL rows begin at the bottom, layers at the top: the flip happens here.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/frame_targets.h"
#include "scene/frame_layers.h"
#include "scene/view.h"

namespace brickfield {

/// Waits for the GPU. Depth becomes metres along the pixel's ray.
FrameLayers readFrameLayers(const FrameTargets& targets, const View& view);

/// RGB8, rows from the top.
std::vector<std::uint8_t> readFramePicture(const FrameTargets& targets);

} // namespace brickfield
