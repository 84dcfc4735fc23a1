// `brickfield bench ao`: ambient occlusion of every form and resolution, how long it takes, what it reads, and how far
// it is from the traced reference's.
#pragma once

#include <filesystem>
#include <vector>

#include "app/field_choice.h"
#include "app/options.h"
#include "passes/light/occlusion_settings.h"

namespace brickfield {

struct OcclusionBenchRequest {
  std::vector<std::filesystem::path> scenes;
  CameraRequest camera{.camera = {}, .eye = {}, .target = {}, .verticalFovDegrees = {}, .sizePixels = {640, 360}};
  SdfRequest sdf;
  FieldChoice field;                                                   ///< settled
  std::filesystem::path cache;                                         ///< of baked bricks; empty: the user's own
  std::filesystem::path json;                                          ///< empty: not asked for
  std::vector<float> radii{1, std::numeric_limits<float>::infinity()}; ///< metres
  std::vector<OcclusionForm> forms{OcclusionForm::Taps, OcclusionForm::Rays, OcclusionForm::Cones};
  std::vector<int> scales{1, 2, 4};
  int samples = 64; ///< of the reference, a pixel; 0: no errors
  int frames = 10;  ///< that are timed
  int device = -1;
};

/// Measures, prints, writes the JSON. A build without bakers has no reference and prints no errors.
/// error  BadInput, Failure, Cancelled
void runOcclusionBench(const OcclusionBenchRequest& request);

} // namespace brickfield
