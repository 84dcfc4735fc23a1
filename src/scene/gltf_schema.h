// The shape of a glTF document: which member has which JSON type and range, and that every index points at something.
// Values (accessor contents, hierarchies, matrices) are checked where they are read.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace brickfield {

/// Checks a document against the glTF 2.0 schema and the extensions that we read. Unknown members are ignored; empty
/// arrays are taken where they mean the same as absent ones, although the schema forbids them.
///
/// document  in: parsed JSON; out: integers that were written as 2.0 are integers
/// error     BadInput that names the file and the element
/// proved by tests/unit/scene/gltf_schema_test.cpp
void checkGltfSchema(nlohmann::json& document, std::string_view file);

/// "accessor 3", or with a name "mesh 1 \"Wheel\"".
std::string elementLabel(std::string_view kind, std::size_t index, std::string_view name = {});

} // namespace brickfield
