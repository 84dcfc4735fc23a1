// Errors of the world field of both methods against the exact distances of the scene's triangles.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench_world_field.h"

namespace brickfield {

/// At each size: the exact field, with SDF objects as the request has them, whose truth is that of their meshes; RTSDF,
/// of all triangles and without its bias, after the request's frames. Prints a line each; in a build without bakers one
/// line that says so.
///
/// returns null where it cannot be measured
nlohmann::ordered_json benchErrors(const FieldBenchSetting& setting);

} // namespace brickfield
