// How far a frame's shadows are from the truth, in figures and as a picture.
#pragma once

#include <cstdint>
#include <vector>

#include "app/image.h"
#include "scene/frame_layers.h"
#include "scene/pose.h"
#include "scene/view.h"

namespace brickfield {

struct ShadowErrors {
  double rmse = 0;     ///< of the visible share
  double mean = 0;     ///< signed: above 0, too light
  double speckled = 0; ///< of lit flat surfaces, no penumbra within two pixels: share darker than 0.98
  double leaking = 0;  ///< of umbrae, no other truth within a pixel: share lighter than 0.1
  std::size_t pixels = 0;
};

/// Pixels that count: both show the same node, at the same depth to a hundredth, and the surface faces the middle of
/// the light. A pixel each: 1 counts.
std::vector<std::uint8_t> comparableShadowPixels(const FrameLayers& frame, const FrameLayers& truth, const View& view,
                                                 const PosedLight& light);

/// frame, truth  shadow layers; every other layer is the truth's
/// proved by     tests/unit/app/shadow_errors_test.cpp
ShadowErrors shadowErrors(const std::vector<float>& frame, const std::vector<float>& truth, const FrameLayers& layers,
                          const std::vector<std::uint8_t>& counts);

/// White where equal, red too light, blue too dark, full at a quarter; grey where nothing counts. Values as coded.
RgbImage shadowHeatMap(const std::vector<float>& frame, const std::vector<float>& truth, glm::uvec2 size,
                       const std::vector<std::uint8_t>& counts);
/// Grey, as coded for the eye.
RgbImage shadowPicture(const std::vector<float>& shadow, glm::uvec2 size);

} // namespace brickfield
