// Cameras and the lights of KHR_lights_punctual.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_node.h"
#include "scene/gltf_schema.h"

namespace brickfield {

namespace {

using nlohmann::json;

void readPerspective(const GltfDocument& document, const tinygltf::PerspectiveCamera& source,
                     const std::string& element, Camera& camera) {
  camera.verticalFovRadians = static_cast<float>(source.yfov);
  if (!(camera.verticalFovRadians > 0.0f && camera.verticalFovRadians < std::numbers::pi_v<float>))
    document.refuse(element, fmt::format("yfov {} is not between 0 and pi", source.yfov));
  if (source.aspectRatio > 0.0) camera.aspect = static_cast<float>(source.aspectRatio);
  camera.nearDistance = static_cast<float>(source.znear);
  if (source.zfar > 0.0) camera.farDistance = static_cast<float>(source.zfar);
}

void readOrthographic(const GltfDocument& document, const tinygltf::OrthographicCamera& source,
                      const std::string& element, Camera& camera) {
  camera.orthographic = true;
  // Negative ones are allowed and mirror the image, "discouraged" by the specification: the size is what counts here.
  camera.halfExtent = {std::abs(static_cast<float>(source.xmag)), std::abs(static_cast<float>(source.ymag))};
  if (!(camera.halfExtent.x > 0.0f && camera.halfExtent.y > 0.0f))
    document.refuse(element, "xmag and ymag must not be 0");
  camera.nearDistance = static_cast<float>(source.znear);
  camera.farDistance = static_cast<float>(source.zfar);
}

LightKind lightKindOf(const std::string& type) {
  if (type == "directional") return LightKind::Sun;
  return type == "spot" ? LightKind::Spot : LightKind::Point;
}

/// What KHR_lights_punctual has no words for, as extras.brickfield of the light: "angle" makes a sun's disk (degrees),
/// "radius" a sphere of a point light, "size" a rectangle of a spot, whose cone then counts for nothing.
class AreaLightReader {
public:
  AreaLightReader(const GltfDocument& document, const std::string& element) : document_(document), element_(element) {}

  void read(const json& source, Light& light) const {
    const auto extras = source.find("extras");
    if (extras == source.end() || !extras->is_object() || !extras->contains("brickfield")) return;
    const json& settings = (*extras)["brickfield"];
    if (!settings.is_object()) document_.refuse(element_, "extras.brickfield is not an object");
    const LightKind kind = light.kind;
    for (const auto& [key, value] : settings.items()) {
      if (key == "angle" && kind == LightKind::Sun) {
        constexpr double kLeastOutOfRange = 180.0;
        light.angleRadians = glm::radians(notNegative(key, value));
        if (value.get<double>() >= kLeastOutOfRange) refuse(key, "is not below 180 degrees");
      } else if (key == "radius" && kind == LightKind::Point) {
        light.radius = notNegative(key, value);
        light.kind = LightKind::Sphere;
      } else if (key == "size" && kind == LightKind::Spot) {
        if (!value.is_array() || value.size() != 2) refuse(key, "is not an array of two numbers");
        light.size = {notNegative(key, value[0]), notNegative(key, value[1])};
        light.kind = LightKind::Rectangle;
      } else {
        refuse(key, "is not known here; there are angle of directional, radius of point and size of spot lights");
      }
    }
  }

private:
  [[noreturn]] void refuse(const std::string& key, const std::string& reason) const {
    document_.refuse(element_, fmt::format("extras.brickfield.{} {}", key, reason));
  }

  float notNegative(const std::string& key, const json& value) const {
    if (!value.is_number()) refuse(key, fmt::format("holds {}, not a number", value.dump()));
    const float number = value.get<float>();
    if (!(number >= 0.0f) || !std::isfinite(number)) refuse(key, fmt::format("holds {}, out of range", value.dump()));
    return number;
  }

  const GltfDocument& document_;
  const std::string& element_;
};

Light readLight(const GltfDocument& document, const json& source, std::size_t index) {
  Light light;
  light.name = source.value("name", "");
  const std::string element = elementLabel("light", index, light.name);
  light.kind = lightKindOf(source["type"].get<std::string>());
  if (const auto color = source.find("color"); color != source.end())
    for (int i = 0; i < 3; ++i) light.color[i] = (*color)[static_cast<std::size_t>(i)].get<float>();
  light.intensity = source.value("intensity", 1.0f);
  light.range = light.kind == LightKind::Sun ? 0.0f : source.value("range", 0.0f);
  if (!isFinite(light.color) || !std::isfinite(light.intensity) || !std::isfinite(light.range))
    document.refuse(element, "color, intensity or range is out of range");
  AreaLightReader(document, element).read(source, light);
  if (light.kind != LightKind::Spot) return light;
  const auto spot = source.find("spot");
  if (spot == source.end()) document.refuse(element, "is a spot without the member spot");
  light.innerConeRadians = spot->value("innerConeAngle", light.innerConeRadians);
  light.outerConeRadians =
      std::min(spot->value("outerConeAngle", light.outerConeRadians), std::numbers::pi_v<float> / 2.0f);
  if (!(light.innerConeRadians < light.outerConeRadians))
    document.refuse(element, fmt::format("innerConeAngle {} is not below outerConeAngle {}", light.innerConeRadians,
                                         light.outerConeRadians));
  return light;
}

} // namespace

void importCameras(GltfDocument& document, Scene& scene) {
  for (std::size_t i = 0; i < document.model->cameras.size(); ++i) {
    const tinygltf::Camera& source = document.model->cameras[i];
    const json& members = document.json["cameras"][i];
    const std::string element = elementLabel("camera", i, source.name);
    const bool isPerspective = source.type == "perspective";
    if (!members.contains(source.type)) document.refuse(element, fmt::format("has no member {}", source.type));
    if (members.contains(isPerspective ? "orthographic" : "perspective"))
      document.refuse(element, "has both perspective and orthographic");
    Camera& camera = scene.cameras.emplace_back();
    camera.name = source.name;
    if (isPerspective)
      readPerspective(document, source.perspective, element, camera);
    else
      readOrthographic(document, source.orthographic, element, camera);
    if (!std::isfinite(camera.nearDistance) || !std::isfinite(camera.farDistance.value_or(1.0f)) ||
        !std::isfinite(camera.aspect.value_or(1.0f)) || !isFinite(camera.halfExtent) ||
        (isPerspective && !(camera.nearDistance > 0.0f)))
      document.refuse(element, "a number is out of range");
    if (camera.farDistance && !(*camera.farDistance > camera.nearDistance))
      document.refuse(element, fmt::format("zfar {} is not above znear {}", *camera.farDistance, camera.nearDistance));
  }
}

void importLights(GltfDocument& document, Scene& scene) {
  const auto extensions = document.json.find("extensions");
  if (extensions == document.json.end() || !extensions->contains("KHR_lights_punctual")) return;
  const json& lights = (*extensions)["KHR_lights_punctual"]["lights"];
  for (std::size_t i = 0; i < lights.size(); ++i) scene.lights.push_back(readLight(document, lights[i], i));
}

} // namespace brickfield
