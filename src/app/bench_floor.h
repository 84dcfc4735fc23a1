// What an update of the world field cannot do without on this memory and these units: each datum once, and one distance
// a texel. Real methods are above it; how far says what is left to gain.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "app/bench_world_field.h"
#include "app/field_bench.h"

namespace brickfield {

struct FieldFloor {
  double bytes = 0;      ///< to and from the memory
  double operations = 0; ///< additions and multiplications alike, a square root for one
};

/// Bytes: the rows of the triangles that were drawn and of the SDF objects, read once; a key a texel of the key tiles;
/// a value and a node a texel of the value tiles, written once. Operations: of one distance from each of those texels,
/// to a triangle, or, in a scene of SDF objects alone, to a brick.
/// proved by tests/unit/app/bench_floor_test.cpp
FieldFloor floorOf(const FieldTimes& times);

/// What the device can do a second: as the user says, else known by the name of the device.
struct DeviceRates {
  std::optional<double> bytes, operations;
};
DeviceRates ratesOf(const FieldBenchRequest& request, const std::string& renderer);

/// Milliseconds of the slower of both; nothing where a rate is not known.
std::optional<double> floorMilliseconds(const FieldFloor& floor, const DeviceRates& rates);

/// One line: bytes, operations, their times, and how many times over them the update took.
std::string floorText(const FieldTimes& times, const DeviceRates& rates);
nlohmann::ordered_json floorJson(const FieldTimes& times, const DeviceRates& rates);

} // namespace brickfield
