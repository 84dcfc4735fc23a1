// Values of the command line from their texts. Every refusal names the flag and quotes the text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"

namespace brickfield {

/// A finite decimal number in [least, most]. error BadInput
double parseNumber(std::string_view flag, std::string_view text, double least, double most);

/// A whole decimal number in [least, most]. error BadInput
std::int64_t parseWhole(std::string_view flag, std::string_view text, std::int64_t least, std::int64_t most);

/// "WIDTHxHEIGHT" in pixels, each 1 to 16384. error BadInput
glm::uvec2 parseSize(std::string_view flag, std::string_view text);

/// "X,Y,Z", finite, no blanks. error BadInput
glm::vec3 parseVector(std::string_view flag, std::string_view text);

/// The pieces between separators; as many as separators plus one.
std::vector<std::string_view> splitText(std::string_view text, char separator);

} // namespace brickfield
