// The project's own settings in a node's extras. Private to the importer.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "scene/gltf_document.h"

namespace brickfield {

/// Settings under extras.brickfield, strictly checked: unknown members, wrong types and values out of range are
/// BadInput that names the node. Everything else in extras is nobody's business.
///
/// node    its JSON; element its label; hasMesh settings on a node without a mesh are an error
SdfSettings readSdfSettings(const GltfDocument& document, const nlohmann::json& node, const std::string& element,
                            bool hasMesh);

} // namespace brickfield
