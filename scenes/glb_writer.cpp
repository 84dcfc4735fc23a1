// glTF 2.0, sections 3.6 (buffers and accessors) and 4.4 (binary container); arrays are not interleaved, every view
// starts on four bytes.
#include "scenes/glb_writer.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <glm/gtc/type_ptr.hpp>

namespace brickfield::scenes {
namespace {

using Json = nlohmann::ordered_json;

// glTF 2.0, 5.1 (component types) and 5.11 (targets).
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

Json vectorJson(glm::vec3 v) { return Json::array({v.x, v.y, v.z}); }

int appendTo(Json& document, const char* array, Json element) {
  Json& elements = document[array];
  elements.push_back(std::move(element));
  return static_cast<int>(elements.size()) - 1;
}

void pad(std::vector<std::byte>& bytes, std::byte filler) {
  while (bytes.size() % 4 != 0) bytes.push_back(filler);
}

void appendWord(std::vector<std::byte>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>((value >> shift) & 0xFF));
}

} // namespace

GlbWriter::GlbWriter() {
  document_["asset"] = {{"version", "2.0"}, {"generator", "brickfield_scenes"}};
  document_["scene"] = 0;
  document_["scenes"] = Json::array({Json{{"nodes", Json::array()}}});
}

int GlbWriter::addView(const void* bytes, std::size_t size, std::optional<int> target) {
  pad(bytes_, std::byte{0});
  Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
  if (target) view["target"] = *target;
  const auto* first = static_cast<const std::byte*>(bytes);
  bytes_.insert(bytes_.end(), first, first + size);
  return appendTo(document_, "bufferViews", std::move(view));
}

int GlbWriter::addAccessor(int view, int componentType, std::size_t count, const char* type, bool normalized) {
  Json accessor{{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}};
  if (normalized) accessor["normalized"] = true;
  return appendTo(document_, "accessors", std::move(accessor));
}

int GlbWriter::addFloats(const std::vector<float>& values, std::size_t perElement, const char* type,
                         std::optional<int> target, bool withBounds) {
  int view = addView(values.data(), values.size() * sizeof(float), target);
  int accessor = addAccessor(view, kFloat, values.size() / perElement, type);
  if (withBounds) {
    std::vector<float> low(perElement, std::numeric_limits<float>::max());
    std::vector<float> high(perElement, std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % perElement] = std::min(low[i % perElement], values[i]);
      high[i % perElement] = std::max(high[i % perElement], values[i]);
    }
    document_["accessors"].back()["min"] = low;
    document_["accessors"].back()["max"] = high;
  }
  return accessor;
}

template <typename Vector>
int GlbWriter::addVectors(const std::vector<Vector>& values, const char* type, bool withBounds) {
  constexpr std::size_t kComponents = Vector::length();
  std::vector<float> floats;
  floats.reserve(values.size() * kComponents);
  for (const Vector& value : values) {
    const float* first = glm::value_ptr(value);
    floats.insert(floats.end(), first, first + kComponents);
  }
  return addFloats(floats, kComponents, type, kVertexTarget, withBounds);
}

int GlbWriter::addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertexCount) {
  // 65535 itself is the restart value and so no index.
  if (vertexCount > 65535) {
    return addAccessor(addView(indices.data(), indices.size() * 4, kIndexTarget), kUnsignedInt, indices.size(),
                       "SCALAR");
  }
  std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  return addAccessor(addView(narrow.data(), narrow.size() * 2, kIndexTarget), kUnsignedShort, narrow.size(), "SCALAR");
}

void GlbWriter::useExtension(const std::string& name, bool required) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (std::string_view(list) == "extensionsRequired" && !required) continue;
    Json& names = document_[list];
    if (std::find(names.begin(), names.end(), Json(name)) == names.end()) names.push_back(name);
  }
}

int GlbWriter::addTexture(const std::string& name, const Png& png) {
  int view = addView(png.data(), png.size(), std::nullopt);
  int image = appendTo(document_, "images", {{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
  // Trilinear, repeating (glTF 2.0, 5.26).
  if (!document_.contains("samplers")) {
    appendTo(document_, "samplers", {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}});
  }
  return appendTo(document_, "textures", {{"name", name}, {"sampler", 0}, {"source", image}});
}

Json GlbWriter::textureInfo(const TextureUse& use) {
  Json info{{"index", use.texture}};
  if (use.uvSet != 0) info["texCoord"] = use.uvSet;
  if (use.scaleUv != 1.0f) {
    useExtension("KHR_texture_transform");
    info["extensions"]["KHR_texture_transform"]["scale"] = {use.scaleUv, use.scaleUv};
  }
  return info;
}

int GlbWriter::addMaterial(const MaterialSpec& spec) {
  Json surface{{"baseColorFactor", Json::array({spec.baseColor.x, spec.baseColor.y, spec.baseColor.z, 1.0f})},
               {"metallicFactor", spec.metallic},
               {"roughnessFactor", spec.roughness}};
  if (spec.baseColorTexture.texture >= 0) surface["baseColorTexture"] = textureInfo(spec.baseColorTexture);
  if (spec.metallicRoughnessTexture.texture >= 0) {
    surface["metallicRoughnessTexture"] = textureInfo(spec.metallicRoughnessTexture);
  }
  Json material{{"name", spec.name}, {"pbrMetallicRoughness", std::move(surface)}};
  if (spec.normalTexture.texture >= 0) {
    material["normalTexture"] = textureInfo(spec.normalTexture);
    if (spec.normalScale != 1.0f) material["normalTexture"]["scale"] = spec.normalScale;
  }
  if (spec.occlusionTexture.texture >= 0) material["occlusionTexture"] = textureInfo(spec.occlusionTexture);
  if (spec.emission != glm::vec3(0)) material["emissiveFactor"] = vectorJson(spec.emission);
  if (spec.emissionStrength != 1.0f) {
    useExtension("KHR_materials_emissive_strength");
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = spec.emissionStrength;
  }
  if (spec.doubleSided) material["doubleSided"] = true;
  return appendTo(document_, "materials", std::move(material));
}

int GlbWriter::addGeometry(const Shape& shape) {
  Json attributes;
  attributes["POSITION"] = addVectors(shape.positions, "VEC3", true);
  if (!shape.normals.empty()) attributes["NORMAL"] = addVectors(shape.normals, "VEC3");
  if (!shape.uvs.empty()) attributes["TEXCOORD_0"] = addVectors(shape.uvs, "VEC2");
  if (!shape.uvsSecond.empty()) attributes["TEXCOORD_1"] = addVectors(shape.uvsSecond, "VEC2");
  if (!shape.colors.empty()) {
    int view = addView(shape.colors.data(), shape.colors.size() * sizeof(Color8), kVertexTarget);
    attributes["COLOR_0"] = addAccessor(view, kUnsignedByte, shape.colors.size(), "VEC4", true);
  }
  if (!shape.joints.empty()) {
    int view = addView(shape.joints.data(), shape.joints.size() * sizeof(Joints8), kVertexTarget);
    attributes["JOINTS_0"] = addAccessor(view, kUnsignedByte, shape.joints.size(), "VEC4");
    attributes["WEIGHTS_0"] = addVectors(shape.jointWeights, "VEC4");
  }
  Json geometry{{"attributes", std::move(attributes)}, {"indices", addIndices(shape.indices, shape.positions.size())}};
  if (!shape.morphPositions.empty()) {
    Json target{{"POSITION", addVectors(shape.morphPositions, "VEC3", true)}};
    if (!shape.morphNormals.empty()) target["NORMAL"] = addVectors(shape.morphNormals, "VEC3");
    geometry["targets"] = Json::array({std::move(target)});
  }
  geometries_.push_back(std::move(geometry));
  return static_cast<int>(geometries_.size()) - 1;
}

int GlbWriter::addMesh(const std::string& name, const std::vector<std::pair<int, int>>& geometryAndMaterial) {
  Json mesh{{"name", name}, {"primitives", Json::array()}};
  for (auto [geometry, material] : geometryAndMaterial) {
    Json primitive = geometries_[static_cast<std::size_t>(geometry)];
    if (material >= 0) primitive["material"] = material;
    if (primitive.contains("targets")) mesh["weights"] = Json::array({0.0f});
    mesh["primitives"].push_back(std::move(primitive));
  }
  return appendTo(document_, "meshes", std::move(mesh));
}

int GlbWriter::addNode(const NodeSpec& spec, int parent) {
  Json node{{"name", spec.name}};
  if (spec.translation != glm::vec3(0)) node["translation"] = vectorJson(spec.translation);
  if (spec.rotation != glm::quat(1, 0, 0, 0)) {
    node["rotation"] = Json::array({spec.rotation.x, spec.rotation.y, spec.rotation.z, spec.rotation.w});
  }
  if (spec.scale != glm::vec3(1)) node["scale"] = vectorJson(spec.scale);
  if (spec.mesh >= 0) node["mesh"] = spec.mesh;
  if (spec.skin >= 0) node["skin"] = spec.skin;
  if (spec.camera >= 0) node["camera"] = spec.camera;
  if (spec.light >= 0) node["extensions"]["KHR_lights_punctual"]["light"] = spec.light;
  if (!spec.extras.is_null()) node["extras"]["brickfield"] = spec.extras;
  int index = appendTo(document_, "nodes", std::move(node));
  if (parent < 0) {
    document_["scenes"][0]["nodes"].push_back(index);
  } else {
    document_["nodes"][static_cast<std::size_t>(parent)]["children"].push_back(index);
  }
  return index;
}

void GlbWriter::addInstances(int node, const std::vector<glm::vec3>& translations,
                             const std::vector<glm::quat>& rotations, const std::vector<glm::vec3>& scales) {
  std::vector<glm::vec4> quaternions;
  for (const glm::quat& q : rotations) quaternions.push_back({q.x, q.y, q.z, q.w});
  useExtension("EXT_mesh_gpu_instancing", true);
  Json attributes{{"TRANSLATION", addVectors(translations, "VEC3")},
                  {"ROTATION", addVectors(quaternions, "VEC4")},
                  {"SCALE", addVectors(scales, "VEC3")}};
  document_["nodes"][static_cast<std::size_t>(node)]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] =
      std::move(attributes);
}

int GlbWriter::addCamera(const std::string& name, float verticalFovRadians, float nearDistance) {
  return appendTo(document_, "cameras",
                  {{"name", name},
                   {"type", "perspective"},
                   {"perspective", {{"yfov", verticalFovRadians}, {"znear", nearDistance}}}});
}

int GlbWriter::addLight(const Json& light) {
  useExtension("KHR_lights_punctual");
  Json& lights = document_["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  return static_cast<int>(lights.size()) - 1;
}

int GlbWriter::addSkin(const std::string& name, const std::vector<int>& joints,
                       const std::vector<glm::mat4>& jointFromBind) {
  std::vector<float> floats;
  for (const glm::mat4& matrix : jointFromBind) {
    const float* first = glm::value_ptr(matrix);
    floats.insert(floats.end(), first, first + 16);
  }
  int matrices = addFloats(floats, 16, "MAT4", std::nullopt, false);
  return appendTo(document_, "skins", {{"name", name}, {"inverseBindMatrices", matrices}, {"joints", joints}});
}

void GlbWriter::setSkin(int node, int mesh, int skin) {
  document_["nodes"][static_cast<std::size_t>(node)]["mesh"] = mesh;
  document_["nodes"][static_cast<std::size_t>(node)]["skin"] = skin;
}

void GlbWriter::addAnimation(const std::string& name, const std::vector<ChannelSpec>& channels) {
  Json animation{{"name", name}, {"samplers", Json::array()}, {"channels", Json::array()}};
  for (const ChannelSpec& channel : channels) {
    bool isWeights = channel.path == "weights";
    std::size_t perValue = isWeights ? 1 : channel.path == "rotation" ? 4 : 3;
    const char* type = isWeights ? "SCALAR" : perValue == 4 ? "VEC4" : "VEC3";
    int input = addFloats(channel.seconds, 1, "SCALAR", std::nullopt, true);
    int output = addFloats(channel.values, perValue, type, std::nullopt, false);
    animation["samplers"].push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", channel.node}, {"path", channel.path}}}});
  }
  appendTo(document_, "animations", std::move(animation));
}

std::vector<std::byte> GlbWriter::finish() {
  pad(bytes_, std::byte{0});
  document_["buffers"] = Json::array({Json{{"byteLength", bytes_.size()}}});
  std::string text = document_.dump();
  while (text.size() % 4 != 0) text += ' ';

  std::vector<std::byte> file;
  appendWord(file, 0x46546C67); // "glTF"
  appendWord(file, 2);
  appendWord(file, 12 + 8 + text.size() + 8 + bytes_.size());
  appendWord(file, text.size());
  appendWord(file, 0x4E4F534A); // "JSON"
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  file.insert(file.end(), first, first + text.size());
  appendWord(file, bytes_.size());
  appendWord(file, 0x004E4942); // "BIN"
  file.insert(file.end(), bytes_.begin(), bytes_.end());
  return file;
}

glm::quat rotationAbout(glm::vec3 axis, float degrees) {
  return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

glm::quat lookRotation(glm::vec3 from, glm::vec3 target) {
  glm::vec3 back = glm::normalize(from - target);
  glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
}

} // namespace brickfield::scenes
