// Sizes of the rows are those of the shared structs.
#include "app/bench_floor.h"

#include <algorithm>

#include <fmt/format.h>

#include "shared/sdf_params.h"
#include "shared/world_field_params.h"

namespace brickfield {

namespace {

constexpr double kKeyBytes = 4, kValueBytes = 2, kNodeBytes = 4;
// squaredTriangleDistance of shaders/lib/triangle_distance.glsl, counted by hand: six differences 18, three clamped
// shares 42, three feet and their squares 35, the foot on the plane 60, its distance 18.
constexpr double kTriangleOperations = 173;
// Of an SDF object: a point to its grid 18, to its box and back 16, the cell and the trilinear read, made by the
// sampler, 6.
constexpr double kBrickOperations = 40;

// NVIDIA's data sheet of the H200 SXM: HBM3e 4.8 TB/s, 67 TFLOPS of FP32.
constexpr double kH200Bytes = 4.8e12, kH200Operations = 67e12;

} // namespace

FieldFloor floorOf(const FieldTimes& times) {
  const double keys = static_cast<double>(times.tiles.keys) * shared::FIELD_TILE_TEXELS;
  const double values = static_cast<double>(times.tiles.values) * shared::FIELD_TILE_TEXELS;
  const bool isMeshes = times.drawn > 0 || times.sdfObjects == 0;
  return {double{sizeof(shared::WorldTriangle)} * times.drawn + double{sizeof(shared::SdfInstance)} * times.sdfObjects +
              kKeyBytes * (times.drawn > 0 ? keys : 0) + (kValueBytes + kNodeBytes) * values,
          (isMeshes ? kTriangleOperations : kBrickOperations) * values};
}

DeviceRates ratesOf(const FieldBenchRequest& request, const std::string& renderer) {
  DeviceRates rates;
  if (renderer.find("H200") != std::string::npos) rates = {kH200Bytes, kH200Operations};
  if (request.bandwidthGigabytes) rates.bytes = *request.bandwidthGigabytes * 1e9;
  if (request.teraOperations) rates.operations = *request.teraOperations * 1e12;
  return rates;
}

std::optional<double> floorMilliseconds(const FieldFloor& floor, const DeviceRates& rates) {
  if (!rates.bytes || !rates.operations) return {};
  return 1e3 * std::max(floor.bytes / *rates.bytes, floor.operations / *rates.operations);
}

std::string floorText(const FieldTimes& times, const DeviceRates& rates) {
  const FieldFloor floor = floorOf(times);
  std::string text =
      fmt::format("floor: {:.1f} MB once, {:.3f} G operations", floor.bytes / 1e6, floor.operations / 1e9);
  const std::optional<double> milliseconds = floorMilliseconds(floor, rates);
  if (!milliseconds) return text + "; this device's rates are not known, see --bandwidth and --tera-operations";
  text += fmt::format(" = {:.4f} and {:.4f} ms at {:g} GB/s and {:g} T/s", 1e3 * floor.bytes / *rates.bytes,
                      1e3 * floor.operations / *rates.operations, *rates.bytes / 1e9, *rates.operations / 1e12);
  if (*milliseconds > 0)
    text += fmt::format("; the update takes {:.1f} times that", times.milliseconds / *milliseconds);
  return text;
}

nlohmann::ordered_json floorJson(const FieldTimes& times, const DeviceRates& rates) {
  const FieldFloor floor = floorOf(times);
  nlohmann::ordered_json json{{"bytes", floor.bytes}, {"operations", floor.operations}};
  const std::optional<double> milliseconds = floorMilliseconds(floor, rates);
  json["ms"] = milliseconds ? nlohmann::ordered_json(*milliseconds) : nullptr;
  json["times_over"] =
      milliseconds && *milliseconds > 0 ? nlohmann::ordered_json(times.milliseconds / *milliseconds) : nullptr;
  return json;
}

} // namespace brickfield
