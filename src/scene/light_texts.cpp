// Parses --light texts. Every number must be whole and finite; the message says which one is not.
#include "scene/light_texts.h"

#include <charconv>
#include <string_view>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr const char* kFlag = "--light";
constexpr const char* kForms = "expected sun:X,Y,Z:DEGREES:LUX, sphere:X,Y,Z:RADIUS:CANDELA, "
                               "rectangle:X,Y,Z:DX,DY,DZ:WIDTH,HEIGHT:CANDELA or none";

std::vector<std::string_view> splitAt(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

float parseNumber(const std::string& text, std::string_view part, const char* meaning) {
  float value = 0.0f;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value))
    throw BadInput(kFlag, text, std::string(meaning) + " \"" + std::string(part) + "\" is not a finite number");
  return value;
}

float parseNotNegative(const std::string& text, std::string_view part, const char* meaning) {
  const float value = parseNumber(text, part, meaning);
  if (value < 0.0f) throw BadInput(kFlag, text, std::string(meaning) + " must not be negative");
  return value;
}

glm::vec3 parseVector(const std::string& text, std::string_view part, const char* meaning) {
  const std::vector<std::string_view> numbers = splitAt(part, ',');
  if (numbers.size() != 3) throw BadInput(kFlag, text, std::string(meaning) + " needs three numbers X,Y,Z");
  return {parseNumber(text, numbers[0], meaning), parseNumber(text, numbers[1], meaning),
          parseNumber(text, numbers[2], meaning)};
}

glm::vec3 parseDirection(const std::string& text, std::string_view part) {
  const glm::dvec3 direction(parseVector(text, part, "direction"));
  if (!(glm::length(direction) > 0.0)) throw BadInput(kFlag, text, "direction must not be zero");
  return glm::vec3(glm::normalize(direction));
}

PosedLight parseSun(const std::string& text, const std::vector<std::string_view>& parts) {
  PosedLight sun;
  sun.light.name = text;
  sun.light.kind = LightKind::Sun;
  sun.directionWorld = parseDirection(text, parts[1]);
  const float degrees = parseNotNegative(text, parts[2], "angle");
  if (degrees >= 180.0f) throw BadInput(kFlag, text, "angle must be below 180 degrees");
  sun.light.angleRadians = glm::radians(degrees);
  sun.light.intensity = parseNotNegative(text, parts[3], "illuminance");
  return sun;
}

PosedLight parseSphere(const std::string& text, const std::vector<std::string_view>& parts) {
  PosedLight sphere;
  sphere.light.name = text;
  sphere.light.kind = LightKind::Sphere;
  sphere.positionWorld = parseVector(text, parts[1], "position");
  sphere.light.radius = parseNotNegative(text, parts[2], "radius");
  sphere.light.intensity = parseNotNegative(text, parts[3], "intensity");
  return sphere;
}

PosedLight parseRectangle(const std::string& text, const std::vector<std::string_view>& parts) {
  PosedLight rectangle;
  rectangle.light.name = text;
  rectangle.light.kind = LightKind::Rectangle;
  rectangle.positionWorld = parseVector(text, parts[1], "position");
  rectangle.directionWorld = parseDirection(text, parts[2]);
  rectangle.rightWorld = levelRightOf(rectangle.directionWorld);
  const std::vector<std::string_view> sides = splitAt(parts[3], ',');
  if (sides.size() != 2) throw BadInput(kFlag, text, "size needs two numbers WIDTH,HEIGHT");
  rectangle.light.size = {parseNotNegative(text, sides[0], "width"), parseNotNegative(text, sides[1], "height")};
  rectangle.light.intensity = parseNotNegative(text, parts[4], "intensity");
  return rectangle;
}

PosedLight parseLight(const std::string& text) {
  const std::vector<std::string_view> parts = splitAt(text, ':');
  if (parts[0] == "sun" && parts.size() == 4) return parseSun(text, parts);
  if (parts[0] == "sphere" && parts.size() == 4) return parseSphere(text, parts);
  if (parts[0] == "rectangle" && parts.size() == 5) return parseRectangle(text, parts);
  throw BadInput(kFlag, text, kForms);
}

} // namespace

std::vector<PosedLight> parseLightTexts(const std::vector<std::string>& lightTexts) {
  std::vector<PosedLight> lights;
  for (const std::string& text : lightTexts) {
    if (text == "none") {
      if (lightTexts.size() > 1) throw BadInput(kFlag, text, "cannot stand beside other lights");
      return {};
    }
    lights.push_back(parseLight(text));
  }
  return lights;
}

} // namespace brickfield
