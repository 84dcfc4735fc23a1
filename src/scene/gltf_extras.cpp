// {"sdf": bool, "resolution": 8..1024, "bits": 8|16, "sign": ..., "thickness": > 0, "opacity": 0..1,
//  "absorption": [r, g, b] >= 0, "triplanar": > 0}, all optional.
#include "scene/gltf_extras.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace brickfield {

namespace {

using nlohmann::json;

class SettingsReader {
public:
  SettingsReader(const GltfDocument& document, const std::string& element) : document_(document), element_(element) {}

  SdfSettings read(const json& object) const {
    SdfSettings settings;
    for (const auto& [key, value] : object.items()) {
      if (key == "sdf")
        settings.sdf = flag(value);
      else if (key == "resolution")
        settings.resolution = integer(key, value, 8, 1024);
      else if (key == "bits")
        settings.bits = bits(value);
      else if (key == "sign")
        settings.sign = sign(value);
      else if (key == "thickness")
        settings.thickness = length(key, value);
      else if (key == "opacity")
        settings.opacity = number(key, value, 0.0, 1.0);
      else if (key == "absorption")
        settings.absorption = absorption(value);
      else if (key == "triplanar")
        settings.triplanar = length(key, value);
      else
        refuse(key, "is not known; there are sdf, resolution, bits, sign, thickness, opacity, absorption, triplanar");
    }
    return settings;
  }

private:
  [[noreturn]] void refuse(const std::string& key, const std::string& reason) const {
    document_.refuse(element_, fmt::format("extras.brickfield.{} {}", key, reason));
  }

  bool flag(const json& value) const {
    // Blender's custom properties wrote booleans as 0 and 1 before it had them; we ask for the real thing.
    if (!value.is_boolean()) refuse("sdf", fmt::format("is {}, neither true nor false", value.dump()));
    return value.get<bool>();
  }

  int integer(const std::string& key, const json& value, int least, int most) const {
    const double exact = number(key, value, least, most);
    if (exact != std::floor(exact)) refuse(key, fmt::format("is {}, not an integer", value.dump()));
    return static_cast<int>(exact);
  }

  float number(const std::string& key, const json& value, double least, double most) const {
    if (!value.is_number()) refuse(key, fmt::format("is {}, not a number", value.dump()));
    const double exact = value.get<double>();
    if (!(exact >= least && exact <= most))
      refuse(key, fmt::format("is {}, out of [{}, {}]", value.dump(), least, most));
    return static_cast<float>(exact);
  }

  int bits(const json& value) const {
    const int count = integer("bits", value, 8, 16);
    if (count != 8 && count != 16) refuse("bits", fmt::format("is {}, neither 8 nor 16", count));
    return count;
  }

  SignMethod sign(const json& value) const {
    static constexpr std::array<std::pair<std::string_view, SignMethod>, 5> kMethods = {{
        {"auto", SignMethod::Auto},
        {"winding", SignMethod::Winding},
        {"parity", SignMethod::Parity},
        {"pseudonormal", SignMethod::Pseudonormal},
        {"two-sided", SignMethod::TwoSided},
    }};
    for (const auto& [name, method] : kMethods)
      if (value.is_string() && value.get_ref<const std::string&>() == name) return method;
    refuse("sign", fmt::format("is {}, none of auto, winding, parity, pseudonormal, two-sided", value.dump()));
  }

  float length(const std::string& key, const json& value) const {
    const float metres = number(key, value, 0.0, static_cast<double>(kLargest));
    if (!(metres > 0.0f)) refuse(key, "is not above 0");
    return metres;
  }

  glm::vec3 absorption(const json& value) const {
    if (!value.is_array() || value.size() != 3) refuse("absorption", "is not an array of three numbers");
    glm::vec3 perMetre;
    for (int i = 0; i < 3; ++i)
      perMetre[i] = number("absorption", value[static_cast<std::size_t>(i)], 0.0, static_cast<double>(kLargest));
    return perMetre;
  }

  static constexpr float kLargest = std::numeric_limits<float>::max();

  const GltfDocument& document_;
  const std::string& element_;
};

} // namespace

SdfSettings readSdfSettings(const GltfDocument& document, const json& node, const std::string& element, bool hasMesh) {
  const auto extras = node.find("extras");
  if (extras == node.end() || !extras->is_object()) return {};
  const auto settings = extras->find("brickfield");
  if (settings == extras->end()) return {};
  if (!settings->is_object()) document.refuse(element, "extras.brickfield is not an object");
  if (!hasMesh) document.refuse(element, "extras.brickfield stands on a node without a mesh");
  return SettingsReader(document, element).read(*settings);
}

} // namespace brickfield
