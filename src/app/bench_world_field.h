// `brickfield bench world-field`: the tables of the RTSDF paper with our figures for both methods beside them, the
// errors of both, the floor of bytes and operations, and crowds of moving SDF objects.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/options.h"
#include "field/field_windows.h"
#include "gpu/context.h"
#include "resident/resident_scene.h"

namespace brickfield {

struct FieldBenchRequest {
  SceneRequest scene;
  CameraRequest camera{.camera = {}, .eye = {}, .target = {}, .verticalFovDegrees = {}, .sizePixels = {1920, 1080}};
  std::filesystem::path json; ///< empty: not asked for
  std::set<std::string> shown{"table1", "table3", "table4", "errors"};
  std::vector<int> moverCounts; ///< not empty: crowds of SDF objects, and nothing else
  FieldShape moverShape;        ///< the cascades that they are in
  std::vector<std::string> sizes{"S", "M", "L"};
  std::vector<int> rays;    ///< a texel of RTSDF; empty: as the paper's tables have them
  std::vector<float> masks; ///< of table 4; empty: as the paper has them
  int frames = 30;          ///< that are timed
  std::vector<int> errorFrames{1, 60};
  std::size_t errorSamples = 2'000'000;     ///< texels of a volume
  std::optional<double> bandwidthGigabytes; ///< a second
  std::optional<double> teraOperations;     ///< a second
  int device = -1;
};

/// What every part of the bench works on.
struct FieldBenchSetting {
  const FieldBenchRequest& request;
  const ContextInfo& device;
  const Scene& scene; ///< as it was loaded
  const Pose& pose;   ///< of its moment

  /// "M" where it is asked for, else the first that is.
  const std::string& mainSize() const;
};

/// The bricks of the nodes that the request makes SDF objects. error BadInput, Cancelled
SceneFields bakeBenchFields(const FieldBenchSetting& setting);

/// Measures, prints, writes the JSON.
/// error  BadInput, Failure, Cancelled
void runFieldBench(const FieldBenchRequest& request);

} // namespace brickfield
