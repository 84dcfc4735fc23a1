// tinygltf has types for the core material; what extensions say is read from the checked JSON.
#include "scene/gltf_material.h"

#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_schema.h"

namespace brickfield {

namespace {

using nlohmann::json;

Wrap wrapOf(int code) {
  if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
  return code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat : Wrap::Repeat;
}

void applySampler(const tinygltf::Sampler& sampler, SceneTexture& texture) {
  texture.wrapU = wrapOf(sampler.wrapS);
  texture.wrapV = wrapOf(sampler.wrapT);
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) texture.magnify = Filter::Nearest;
  switch (sampler.minFilter) {
  case TINYGLTF_TEXTURE_FILTER_NEAREST:
    texture.minify = Filter::Nearest, texture.mipmap.reset();
    break;
  case TINYGLTF_TEXTURE_FILTER_LINEAR:
    texture.minify = Filter::Linear, texture.mipmap.reset();
    break;
  case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    texture.minify = texture.mipmap.emplace(Filter::Nearest);
    break;
  case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    texture.minify = Filter::Linear, texture.mipmap = Filter::Nearest;
    break;
  case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
    texture.minify = Filter::Nearest, texture.mipmap = Filter::Linear;
    break;
  default:
    break; // trilinear, also where the file leaves it to us
  }
}

const json* extensionOf(const json& object, std::string_view name) {
  const auto extensions = object.find("extensions");
  if (extensions == object.end()) return nullptr;
  const auto extension = extensions->find(std::string(name));
  return extension == extensions->end() ? nullptr : &*extension;
}

// uv' = T * R * S * uv. The extension says "counter-clockwise", which in glTF's downward v is R = [cos sin; -sin cos];
// its example code turns the other way. The markers of the sample TextureTransformTest decide for the text
// (tests/unit/scene/gltf_material_test.cpp).
glm::mat3 textureFromUv(const json& transform) {
  glm::vec2 offset(0.0f), scale(1.0f);
  if (const auto it = transform.find("offset"); it != transform.end())
    offset = {(*it)[0].get<float>(), (*it)[1].get<float>()};
  if (const auto it = transform.find("scale"); it != transform.end())
    scale = {(*it)[0].get<float>(), (*it)[1].get<float>()};
  const float rotation = transform.value("rotation", 0.0f);
  const float c = std::cos(rotation), s = std::sin(rotation);
  // Columns.
  return glm::mat3(glm::vec3(c * scale.x, -s * scale.x, 0.0f), glm::vec3(s * scale.y, c * scale.y, 0.0f),
                   glm::vec3(offset, 1.0f));
}

glm::vec3 colorOf(const json& extension, const char* name) {
  glm::vec3 color(1.0f);
  if (const auto it = extension.find(name); it != extension.end())
    for (int i = 0; i < 3; ++i) color[i] = (*it)[static_cast<std::size_t>(i)].get<float>();
  return color;
}

// The colour is what is left after the distance. Black would be infinitely dense; a millionth is as black.
glm::vec3 absorptionOf(const json& volume) {
  const float distance = volume.value("attenuationDistance", std::numeric_limits<float>::infinity());
  const glm::vec3 left = glm::clamp(colorOf(volume, "attenuationColor"), 1e-6f, 1.0f);
  const glm::vec3 perMetre = -glm::log(left) / distance;
  return glm::min(perMetre, glm::vec3(std::numeric_limits<float>::max()));
}

class MaterialReader {
public:
  MaterialReader(GltfDocument& document, const Scene& scene, std::size_t index)
      : document_(document),
        scene_(scene),
        source_(document.model->materials[index]),
        json_(document.json["materials"][index]),
        element_(elementLabel("material", index, source_.name)) {}

  Material read() {
    Material material;
    material.name = source_.name;
    const auto& pbr = source_.pbrMetallicRoughness;
    for (int i = 0; i < 4 && pbr.baseColorFactor.size() == 4; ++i)
      material.baseColor[i] = unit(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    material.metallic = unit(pbr.metallicFactor);
    material.roughness = unit(pbr.roughnessFactor);
    for (int i = 0; i < 3 && source_.emissiveFactor.size() == 3; ++i)
      material.emission[i] = unit(source_.emissiveFactor[static_cast<std::size_t>(i)]);
    if (const json* strength = extensionOf(json_, "KHR_materials_emissive_strength"))
      material.emission *= strength->value("emissiveStrength", 1.0f);
    if (!isFinite(material.emission)) document_.refuse(element_, "emission is out of range");
    material.alphaMode = source_.alphaMode == "MASK"    ? AlphaMode::Mask
                         : source_.alphaMode == "BLEND" ? AlphaMode::Blend
                                                        : AlphaMode::Opaque;
    material.alphaCutoff = static_cast<float>(source_.alphaCutoff);
    material.doubleSided = source_.doubleSided;
    material.unlit = extensionOf(json_, "KHR_materials_unlit") != nullptr;
    if (const json* transmission = extensionOf(json_, "KHR_materials_diffuse_transmission")) {
      material.diffuseTransmission = unit(transmission->value("diffuseTransmissionFactor", 0.0));
      material.diffuseTransmissionColor = colorOf(*transmission, "diffuseTransmissionColorFactor");
      if (!isFinite(material.diffuseTransmissionColor)) document_.refuse(element_, "its transmission is out of range");
    }
    if (const json* volume = extensionOf(json_, "KHR_materials_volume")) material.absorption = absorptionOf(*volume);
    const json& pbrJson = json_.contains("pbrMetallicRoughness") ? json_["pbrMetallicRoughness"] : kNothing;
    material.baseColorTexture = slot(pbrJson, "baseColorTexture");
    material.metallicRoughnessTexture = slot(pbrJson, "metallicRoughnessTexture");
    material.normalTexture = slot(json_, "normalTexture");
    material.occlusionTexture = slot(json_, "occlusionTexture");
    material.emissionTexture = slot(json_, "emissiveTexture");
    material.normalScale = static_cast<float>(source_.normalTexture.scale);
    material.occlusionStrength = unit(source_.occlusionTexture.strength);
    return material;
  }

private:
  inline static const json kNothing = json::object();

  static float unit(double factor) { return static_cast<float>(std::min(std::max(factor, 0.0), 1.0)); }

  TextureSlot slot(const json& owner, const char* name) const {
    TextureSlot slot;
    const auto info = owner.find(name);
    if (info == owner.end()) return slot;
    std::int64_t uvSet = info->value("texCoord", std::int64_t{0});
    if (const json* transform = extensionOf(*info, "KHR_texture_transform")) {
      slot.textureFromUv = textureFromUv(*transform);
      uvSet = transform->value("texCoord", uvSet);
      for (int column = 0; column < 3; ++column)
        if (!isFinite(slot.textureFromUv[column]))
          document_.refuse(element_, fmt::format("{}: its transform is out of range", name));
    }
    const int texture = (*info)["index"].get<int>();
    if (uvSet > 1)
      document_.warnings.push_back(
          fmt::format("{}: {} uses TEXCOORD_{}, only 0 and 1 are read; it is left out", element_, name, uvSet));
    else if (scene_.textures[static_cast<std::size_t>(texture)].image < 0)
      document_.warnings.push_back(fmt::format(
          "{}: {} uses texture {}, which has no image that is read; it is left out", element_, name, texture));
    else
      slot.texture = texture, slot.uvSet = static_cast<int>(uvSet);
    return slot;
  }

  GltfDocument& document_;
  const Scene& scene_;
  const tinygltf::Material& source_;
  const json& json_;
  std::string element_;
};

} // namespace

void importMaterials(GltfDocument& document, Scene& scene) {
  for (const tinygltf::Texture& source : document.model->textures) {
    SceneTexture& texture = scene.textures.emplace_back();
    texture.image = source.source;
    if (source.sampler >= 0) applySampler(document.model->samplers[static_cast<std::size_t>(source.sampler)], texture);
  }
  for (std::size_t i = 0; i < document.model->materials.size(); ++i)
    scene.materials.push_back(MaterialReader(document, scene, i).read());
}

} // namespace brickfield
