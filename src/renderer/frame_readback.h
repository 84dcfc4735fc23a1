// The frame's textures as layers on the CPU. GL rows begin at the bottom, layers at the top: the flip happens here.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/frame_targets.h"
#include "scene/frame_layers.h"
#include "scene/view.h"

namespace brickfield {

/// Waits for the GPU. Depth becomes metres along the pixel's ray.
///
/// shadowedLights  whose layers are made
/// nodeOfInstance  of the SDF objects that the frame drew
FrameLayers readFrameLayers(const FrameTargets& targets, const View& view, std::uint32_t shadowedLights,
                            const std::vector<std::int32_t>& nodeOfInstance);

/// Of each pixel, rows from the top.
std::vector<std::uint32_t> readFrameShadowReads(const FrameTargets& targets);

/// RGB8, rows from the top.
std::vector<std::uint8_t> readFramePicture(const FrameTargets& targets);

} // namespace brickfield
