// JSON from strangers: bounded nesting and bounded size before any parser that recurses or allocates sees the text.
#pragma once

#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

namespace brickfield {

/// What a text would cost a parser, found without building anything.
struct JsonExtent {
  std::uint64_t depth = 0;  ///< deepest nesting of arrays and objects; brackets inside strings do not count
  std::uint64_t values = 0; ///< upper bound of the values: one more than the commas, colons and opening brackets
};

/// Scans any text, well-formed or not. cost linear, no memory
JsonExtent measureJson(std::string_view text);

/// Parses text after it was measured.
///
/// file      subject of the messages; depthLimit deepest nesting allowed
/// returns   the document, an object
/// error     BadInput: byte order mark, nested too deep, too many values, syntax, numbers out of range, no object
/// proved by tests/unit/scene/json_guard_test.cpp
nlohmann::json parseGuardedJson(std::string_view text, std::string_view file, int depthLimit);

} // namespace brickfield
