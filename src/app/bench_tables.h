// The tables of the RTSDF paper, measured here: each function prints one and returns it as JSON. What a table has that
// cannot be measured is said so.
#pragma once

#include <nlohmann/json.hpp>

#include "app/bench_world_field.h"
#include "app/field_bench.h"

namespace brickfield {

/// A scene with a mover, all of it as meshes.
struct BenchedScene {
  const FieldBenchSetting& setting;
  const Scene& scene;
  const Pose& rest;
  FieldBench& bench;
};

/// One window over the scene, of a size's fine texels.
FieldShape shapeOfSize(const std::string& size);
/// error BadInput: no such size
RtsdfSettings rtsdfOfSize(const FieldBenchRequest& request, const std::string& size);

/// Table 1: a whole frame with one directional light, by the renderer, everything moving.
nlohmann::ordered_json benchFrameTable(const BenchedScene& scene);
/// Table 3: passes of the field by size and rays; the exact field, and how far it is from its floor, below.
nlohmann::ordered_json benchSizeTable(const BenchedScene& scene);
/// Table 4: the ray pass by mask width and rays.
nlohmann::ordered_json benchMaskTable(const BenchedScene& scene);

/// The passes of a table's row, its tiles and bytes.
nlohmann::ordered_json jsonOf(const FieldTimes& times);
/// "splat 0.10 resolve 0.20": passes that took any time.
std::string passesText(const FieldTimes& times);

} // namespace brickfield
