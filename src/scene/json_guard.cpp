// One pass over the characters, then nlohmann's parser; where it fails a second, slower one finds line and column.
#include "scene/json_guard.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {
// A parsed value takes 16 bytes and more: this keeps a hostile document under some gigabytes. A million nodes with
// names, transforms and meshes have about 30 million values.
constexpr std::uint64_t kMostValues = std::uint64_t{1} << 26;

/// Where the text stops being JSON, and why; builds nothing.
class FaultFinder final : public nlohmann::json::json_sax_t {
public:
  explicit FaultFinder(std::string_view text) : text_(text) {}

  std::string fault() {
    nlohmann::json::sax_parse(text_, this);
    return fault_;
  }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    const std::string_view before = text_.substr(0, std::min(position > 0 ? position - 1 : 0, text_.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t lineBegin = before.rfind('\n') + 1; // npos + 1 is 0
    fault_ = fmt::format("line {}, column {}: {}", line, before.size() - lineBegin + 1, reasonOf(error.what()));
    return false;
  }

private:
  /// "[json.exception.parse_error.101] parse error at ...: syntax error while parsing ... - REASON": of use to a reader
  /// is what follows the dash, or the bracket where there is none.
  static std::string reasonOf(std::string_view message) {
    for (const std::string_view mark : {" - ", "] "})
      if (const std::size_t at = message.find(mark); at != std::string_view::npos)
        return std::string(message.substr(at + mark.size()));
    return std::string(message);
  }

  std::string_view text_;
  std::string fault_;
};

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
  } catch (const nlohmann::json::exception&) {
    throw BadInput(file, "JSON", FaultFinder(text).fault());
  }
  if (!document.is_object())
    throw BadInput(file, "JSON", fmt::format("is a JSON {}, not an object", document.type_name()));
  return document;
}

} // namespace brickfield
