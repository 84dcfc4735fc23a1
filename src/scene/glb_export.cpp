// glTF 2.0, 3.6 (buffers and accessors) and 4.4 (binary container). JSON by hand: tinygltf's writer encodes images and
// writes numbers through locale-bound streams.
#include "scene/glb_export.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace brickfield {

namespace {

using nlohmann::ordered_json;

// glTF 2.0, 5.1 (component types) and 5.11 (targets).
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

constexpr const char* kEmissiveStrength = "KHR_materials_emissive_strength";

ordered_json jsonOf(glm::vec3 v) { return ordered_json::array({v.x, v.y, v.z}); }

/// The binary chunk and what refers to it. Every element has four bytes or a multiple, so views stay aligned.
class BufferBuilder {
public:
  template <typename Element>
  int add(const std::vector<Element>& elements, int componentType, const char* type, int target) {
    static_assert(sizeof(Element) % 4 == 0);
    const auto bytes = std::as_bytes(std::span(elements));
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}, {"target", target}});
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", componentType},
                          {"count", elements.size()},
                          {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }
  ordered_json& accessor(int index) { return accessors_[static_cast<std::size_t>(index)]; }

  const std::vector<std::byte>& bytes() const { return bytes_; }
  const ordered_json& views() const { return views_; }
  const ordered_json& accessors() const { return accessors_; }

private:
  std::vector<std::byte> bytes_;
  ordered_json views_ = ordered_json::array(), accessors_ = ordered_json::array();
};

std::vector<std::array<std::uint16_t, 4>> packColors(const std::vector<glm::vec4>& colors) {
  std::vector<std::array<std::uint16_t, 4>> packed;
  packed.reserve(colors.size());
  const auto code = [](float unit) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(unit, 0.0f, 1.0f) * 65535.0f));
  };
  for (const glm::vec4& color : colors) packed.push_back({code(color.x), code(color.y), code(color.z), 65535});
  return packed;
}

ordered_json attributesOf(const Primitive& primitive, BufferBuilder& buffer) {
  ordered_json attributes;
  const int positions = buffer.add(primitive.positions, kFloat, "VEC3", kVertexTarget);
  Box box;
  for (const glm::vec3 position : primitive.positions) box.extend(position);
  buffer.accessor(positions)["min"] = jsonOf(box.min);
  buffer.accessor(positions)["max"] = jsonOf(box.max);
  attributes["POSITION"] = positions;
  attributes["NORMAL"] = buffer.add(primitive.normals, kFloat, "VEC3", kVertexTarget);
  if (primitive.colors.empty()) return attributes;
  const int colors = buffer.add(packColors(primitive.colors), kUnsignedShort, "VEC4", kVertexTarget);
  buffer.accessor(colors)["normalized"] = true;
  attributes["COLOR_0"] = colors;
  return attributes;
}

/// How far emission is over what a factor can say, 1 at least.
float strengthOf(glm::vec3 emission) { return std::max({1.0f, emission.x, emission.y, emission.z}); }

ordered_json jsonOf(const Material& material) {
  const glm::vec4 c = material.baseColor;
  ordered_json json = {{"pbrMetallicRoughness",
                        {{"baseColorFactor", {c.x, c.y, c.z, c.w}},
                         {"metallicFactor", material.metallic},
                         {"roughnessFactor", material.roughness}}}};
  if (material.emission == glm::vec3(0)) return json;
  const float strength = strengthOf(material.emission);
  json["emissiveFactor"] = jsonOf(material.emission / strength);
  if (strength > 1) json["extensions"][kEmissiveStrength] = {{"emissiveStrength", strength}};
  return json;
}

void appendWord(std::vector<std::byte>& file, std::uint64_t value) {
  for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

} // namespace

std::vector<std::byte> encodeGlb(const std::string& name, const Primitive& primitive, const Material& material) {
  BufferBuilder buffer;
  ordered_json attributes = attributesOf(primitive, buffer);
  const int indices = buffer.add(primitive.indices, kUnsignedInt, "SCALAR", kIndexTarget);
  ordered_json document;
  document["asset"] = {{"version", "2.0"}, {"generator", "brickfield"}};
  if (strengthOf(material.emission) > 1) document["extensionsUsed"] = {kEmissiveStrength};
  document["scene"] = 0;
  document["scenes"] = {{{"nodes", {0}}}};
  document["nodes"] = {{{"name", name}, {"mesh", 0}}};
  document["meshes"] = {
      {{"name", name},
       {"primitives", {{{"attributes", std::move(attributes)}, {"indices", indices}, {"material", 0}}}}}};
  document["materials"] = ordered_json::array({jsonOf(material)});
  document["accessors"] = buffer.accessors();
  document["bufferViews"] = buffer.views();
  document["buffers"] = {{{"byteLength", buffer.bytes().size()}}};
  // A node's name is a file's, whose bytes need not be UTF-8.
  std::string text = document.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  while (text.size() % 4 != 0) text += ' ';

  const std::uint64_t fileBytes = 12 + 8 + std::uint64_t{text.size()} + 8 + buffer.bytes().size();
  if (fileBytes > std::numeric_limits<std::uint32_t>::max())
    throw BadInput(name, "", fmt::format("{} bytes are more than a .glb can hold; take a coarser level", fileBytes));
  std::vector<std::byte> file;
  file.reserve(fileBytes);
  appendWord(file, 0x46546C67); // "glTF"
  appendWord(file, 2);
  appendWord(file, fileBytes);
  appendWord(file, text.size());
  appendWord(file, 0x4E4F534A); // "JSON"
  const auto json = std::as_bytes(std::span(text));
  file.insert(file.end(), json.begin(), json.end());
  appendWord(file, buffer.bytes().size());
  appendWord(file, 0x004E4942); // "BIN"
  file.insert(file.end(), buffer.bytes().begin(), buffer.bytes().end());
  return file;
}

} // namespace brickfield
