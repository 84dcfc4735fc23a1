// std::from_chars throughout: independent of the locale, and nothing is read past a number unnoticed.
#include "app/parse.h"

#include <charconv>

#include <fmt/format.h>

#include "app/image.h"
#include "core/error.h"

namespace brickfield {

namespace {

BadInput refuse(std::string_view flag, std::string_view text, const std::string& reason) {
  return BadInput(flag, fmt::format("\"{}\"", text), reason);
}

template <typename Value>
bool readsWhole(std::string_view text, Value& value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

} // namespace

std::vector<std::string_view> splitText(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (std::size_t end; (end = text.find(separator)) != std::string_view::npos; text.remove_prefix(end + 1))
    pieces.push_back(text.substr(0, end));
  pieces.push_back(text);
  return pieces;
}

double parseNumber(std::string_view flag, std::string_view text, double least, double most) {
  double value = 0;
  if (!readsWhole(text, value) || !std::isfinite(value)) throw refuse(flag, text, "is no finite number");
  if (value < least || value > most) throw refuse(flag, text, fmt::format("is not from {:g} to {:g}", least, most));
  return value;
}

std::int64_t parseWhole(std::string_view flag, std::string_view text, std::int64_t least, std::int64_t most) {
  std::int64_t value = 0;
  if (!readsWhole(text, value)) throw refuse(flag, text, "is no whole number");
  if (value < least || value > most) throw refuse(flag, text, fmt::format("is not from {} to {}", least, most));
  return value;
}

glm::uvec2 parseSize(std::string_view flag, std::string_view text) {
  const auto pieces = splitText(text, 'x');
  glm::uvec2 size{0};
  if (pieces.size() != 2 || !readsWhole(pieces[0], size.x) || !readsWhole(pieces[1], size.y))
    throw refuse(flag, text, "is not WIDTHxHEIGHT, such as 1280x720");
  if (size.x < 1 || size.y < 1 || size.x > kLargestImageSide || size.y > kLargestImageSide)
    throw refuse(flag, text, fmt::format("each side must be from 1 to {} pixels", kLargestImageSide));
  if (std::uint64_t{size.x} * size.y > kLargestImagePixels)
    throw refuse(flag, text, fmt::format("more than {} pixels in all", kLargestImagePixels));
  return size;
}

glm::vec3 parseVector(std::string_view flag, std::string_view text) {
  const auto pieces = splitText(text, ',');
  glm::vec3 vector{0.0f};
  bool isRead = pieces.size() == 3;
  for (int axis = 0; isRead && axis < 3; ++axis)
    isRead = readsWhole(pieces[static_cast<std::size_t>(axis)], vector[axis]);
  if (!isRead || !isFinite(vector)) throw refuse(flag, text, "is not X,Y,Z, three finite numbers without blanks");
  return vector;
}

} // namespace brickfield
