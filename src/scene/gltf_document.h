// A glTF file between the disk and the Scene: checked JSON, tinygltf's typed model of it, the buffers' bytes, warnings
// and what is left of the limits. Private to the importer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/gltf_import.h"

namespace tinygltf {
class Model;
}

namespace brickfield {

struct GltfDocument {
  std::string file;             ///< name for messages
  std::filesystem::path folder; ///< where uris start; empty: none may name a file
  ImportLimits limits;
  nlohmann::json json;                    ///< the schema holds; without `buffers`, whose bytes are below
  std::shared_ptr<tinygltf::Model> model; ///< without buffers and images; accessors without a view have -1
  /// One for each glTF buffer, at least byteLength long; nothing where the file gives it no data.
  std::vector<std::optional<std::span<const std::byte>>> buffers;
  std::vector<std::uint64_t> bufferBytes; ///< byteLength of each
  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> files; ///< that buffers and images name, whether they are read or not

  std::uint64_t verticesLeft = 0; ///< also spent on morph targets, keys and instances
  std::uint64_t indicesLeft = 0;

  std::vector<std::byte> fileBytes;               ///< owns what a GLB's first buffer views
  std::vector<std::vector<std::byte>> ownedBytes; ///< owns what the other buffers view

  /// error BadInput that names the file and `element`
  [[noreturn]] void refuse(std::string_view element, std::string_view reason) const;
  /// Takes from verticesLeft before anything of that size is allocated.
  void spendVertices(std::uint64_t count, std::string_view element);
  void spendIndices(std::uint64_t count, std::string_view element);
  bool uses(std::string_view extension) const;
};

/// Splits, parses, validates and loads the buffers; hands the rest to tinygltf, whose exceptions and errors become
/// BadInput. Element contents are not looked at yet.
///
/// bytes  the whole file
/// file   name for messages; folder where uris start
GltfDocument openGltf(std::vector<std::byte> bytes, const std::string& file, const std::filesystem::path& folder,
                      const ImportLimits& limits);

/// The whole import for bytes in memory; importGltf reads the file and calls it.
Scene importGltfBytes(std::vector<std::byte> bytes, const std::string& file, const std::filesystem::path& folder,
                      const ImportLimits& limits = {});

/// The first error of tinygltf's text as one line.
std::string firstLine(std::string_view text);

} // namespace brickfield
