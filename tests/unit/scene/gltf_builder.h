// Small glTF files made in memory: accessors from values, the rest as JSON text. Imports them as a GLB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "scene/gltf_document.h"

namespace brickfield::test {

template <typename Number>
constexpr int componentTypeOf() {
  if constexpr (std::is_same_v<Number, std::int8_t>)
    return 5120;
  else if constexpr (std::is_same_v<Number, std::uint8_t>)
    return 5121;
  else if constexpr (std::is_same_v<Number, std::int16_t>)
    return 5122;
  else if constexpr (std::is_same_v<Number, std::uint16_t>)
    return 5123;
  else if constexpr (std::is_same_v<Number, std::uint32_t>)
    return 5125;
  else
    return 5126;
}

class GltfBuilder {
public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};

  /// Appends bytes at a multiple of four and returns the view's number.
  int view(const void* source, std::size_t bytes, int byteStride = 0) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
    if (byteStride != 0) view["byteStride"] = byteStride;
    const auto* first = static_cast<const std::byte*>(source);
    binary_.insert(binary_.end(), first, first + bytes);
    return append("bufferViews", view);
  }
  template <typename Number>
  int view(const std::vector<Number>& numbers) {
    return view(numbers.data(), numbers.size() * sizeof(Number));
  }

  template <typename Number>
  int accessor(std::string_view type, const std::vector<Number>& numbers, bool normalized = false) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
    nlohmann::json accessor = {{"bufferView", view(numbers)},
                               {"componentType", componentTypeOf<Number>()},
                               {"count", numbers.size() / width},
                               {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return append("accessors", accessor);
  }

  /// Appends to a root array and returns the element's number.
  int append(const char* array, nlohmann::json element) {
    root[array].push_back(std::move(element));
    return static_cast<int>(root[array].size()) - 1;
  }
  int append(const char* array, const char* text) { return append(array, nlohmann::json::parse(text)); }

  /// A mesh of one primitive; `more` is merged into the primitive.
  int mesh(nlohmann::json attributes, nlohmann::json more = nlohmann::json::object()) {
    nlohmann::json primitive = {{"attributes", std::move(attributes)}};
    primitive.update(more);
    return append("meshes", {{"primitives", {primitive}}});
  }

  std::vector<std::byte> glb() const {
    nlohmann::json document = root;
    if (!binary_.empty()) document["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::byte> binary = binary_;
    binary.resize((binary.size() + 3) / 4 * 4);
    std::vector<std::byte> bytes;
    const auto put = [&](std::uint32_t value) {
      for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i) & 0xFF));
    };
    const std::size_t total = 20 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
    put(0x46546C67), put(2), put(static_cast<std::uint32_t>(total));
    put(static_cast<std::uint32_t>(text.size())), put(0x4E4F534A);
    for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
    if (binary.empty()) return bytes;
    put(static_cast<std::uint32_t>(binary.size())), put(0x004E4942);
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    return bytes;
  }

  Scene import(const ImportLimits& limits = {}) const { return importGltfBytes(glb(), "test.glb", {}, limits); }

  /// The message that the import fails with; empty where it does not fail.
  std::string error(const ImportLimits& limits = {}) const {
    try {
      import(limits);
    } catch (const BadInput& error) {
      return error.what();
    }
    return {};
  }

private:
  std::vector<std::byte> binary_;
};

/// Imports JSON text as a .gltf without a folder; the message that it fails with, or nothing.
inline std::string errorOfText(std::string_view text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  try {
    importGltfBytes(std::move(bytes), "test.gltf", {});
  } catch (const BadInput& error) {
    return error.what();
  }
  return {};
}

/// Positions of a unit square in the plane z = 0, counter-clockwise.
inline std::vector<float> squarePositions() { return {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}; }
inline std::vector<float> squareNormals() { return {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}; }

} // namespace brickfield::test
