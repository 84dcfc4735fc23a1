// One pass over the characters, then nlohmann's parser with its exceptions turned into BadInput.
#include "scene/json_guard.h"

#include <algorithm>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {
// A parsed value takes 16 bytes and more: this keeps a hostile document under some gigabytes. A million nodes with
// names, transforms and meshes have about 30 million values.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 26;
} // namespace

JsonExtent measureJson(std::string_view text) {
  JsonExtent extent{0, 1};
  std::uint64_t depth = 0;
  bool inString = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inString) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        inString = false;
      continue;
    }
    switch (c) {
    case '"':
      inString = true;
      break;
    case '[':
    case '{':
      ++extent.values;
      extent.depth = std::max(extent.depth, ++depth);
      break;
    case ']':
    case '}':
      if (depth > 0) --depth;
      break;
    case ',':
    case ':':
      ++extent.values;
      break;
    default:
      break;
    }
  }
  return extent;
}

nlohmann::json parseGuardedJson(std::string_view text, std::string_view file, int depthLimit) {
  if (text.starts_with("\xEF\xBB\xBF"))
    throw BadInput(file, "JSON", "starts with a byte order mark, which glTF forbids");
  const JsonExtent extent = measureJson(text);
  if (extent.depth > static_cast<std::uint64_t>(std::max(depthLimit, 0)))
    throw BadInput(file, "JSON", fmt::format("nested {} deep, at most {} is read", extent.depth, depthLimit));
  if (extent.values > kMostValues)
    throw BadInput(file, "JSON", fmt::format("about {} values, at most {} are read", extent.values, kMostValues));
  nlohmann::json document;
  try {
    document = nlohmann::json::parse(text);
  } catch (const std::exception& error) {
    throw BadInput(file, "JSON", error.what());
  }
  if (!document.is_object())
    throw BadInput(file, "JSON", fmt::format("is a JSON {}, not an object", document.type_name()));
  return document;
}

} // namespace brickfield
