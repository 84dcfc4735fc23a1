// How long the world field takes over crowds of SDF objects that all move.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench_world_field.h"

namespace brickfield {

/// For each count of the request: as many of the scene's SDF objects on a jittered grid, circling and turning, in
/// cascades that hold them all. Prints a line each. Bricks come from the cache where they are there, so a build without
/// bakers measures what was baked before.
/// error BadInput: the scene has no SDF object, or one cannot be baked; Cancelled
nlohmann::ordered_json benchMovers(const FieldBenchSetting& setting);

} // namespace brickfield
