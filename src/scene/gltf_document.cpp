// Opening a glTF: container, JSON, schema, versions, extensions, buffers, tinygltf.
#include "scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <set>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "core/error.h"
#include "scene/gltf_container.h"
#include "scene/gltf_schema.h"
#include "scene/gltf_uri.h"
#include "scene/json_guard.h"

namespace brickfield {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 6> kSupportedExtensions = {
    "EXT_mesh_gpu_instancing", "KHR_lights_punctual",   "KHR_materials_emissive_strength",
    "KHR_materials_unlit",     "KHR_mesh_quantization", "KHR_texture_transform"};

// Their factors are read, not their textures, and by SDF objects alone: a file that cannot do without them is refused.
constexpr std::array<std::string_view, 2> kPartlyReadExtensions = {"KHR_materials_diffuse_transmission",
                                                                   "KHR_materials_volume"};

bool isPartlyRead(std::string_view extension) {
  return std::find(kPartlyReadExtensions.begin(), kPartlyReadExtensions.end(), extension) !=
         kPartlyReadExtensions.end();
}

bool isSupported(std::string_view extension) {
  return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), extension) != kSupportedExtensions.end();
}

struct Version {
  int major = 0;
  int minor = 0;
  auto operator<=>(const Version&) const = default;
};

// "2.0": digits, a dot, digits, nothing else.
std::optional<Version> parseVersion(const std::string& text) {
  const std::size_t dot = text.find('.');
  const auto isNumber = [](std::string_view digits) {
    return !digits.empty() && digits.size() < 5 &&
           std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  };
  if (dot == std::string::npos) return std::nullopt;
  const std::string major = text.substr(0, dot), minor = text.substr(dot + 1);
  if (!isNumber(major) || !isNumber(minor)) return std::nullopt;
  return Version{std::stoi(major), std::stoi(minor)};
}

void checkVersions(const GltfDocument& document) {
  const json& asset = document.json["asset"];
  const std::string text = asset["version"].get<std::string>();
  const std::optional<Version> version = parseVersion(text);
  if (!version) document.refuse("asset", fmt::format("version \"{}\" is not of the form \"2.0\"", text));
  if (version->major != 2) document.refuse("asset", fmt::format("glTF version {}, only 2.x is read", text));
  if (!asset.contains("minVersion")) return;
  const std::string leastText = asset["minVersion"].get<std::string>();
  const std::optional<Version> least = parseVersion(leastText);
  if (!least) document.refuse("asset", fmt::format("minVersion \"{}\" is not of the form \"2.0\"", leastText));
  if (*least > *version) document.refuse("asset", fmt::format("minVersion {} is above version {}", leastText, text));
  if (*least > Version{2, 0}) document.refuse("asset", fmt::format("asks for glTF {}, 2.0 is read", leastText));
}

void checkExtensions(GltfDocument& document) {
  std::set<std::string> used;
  if (document.json.contains("extensionsUsed"))
    for (const json& name : document.json["extensionsUsed"]) used.insert(name.get<std::string>());
  if (document.json.contains("extensionsRequired"))
    for (const json& name : document.json["extensionsRequired"]) {
      const std::string extension = name.get<std::string>();
      if (!isSupported(extension)) document.refuse("extensionsRequired", fmt::format("{} is not supported", extension));
      if (!used.contains(extension))
        document.refuse("extensionsRequired", fmt::format("{} is missing from extensionsUsed", extension));
    }
  for (const std::string& extension : used)
    if (!isSupported(extension))
      document.warnings.push_back(fmt::format("extension {} is {}", extension,
                                              isPartlyRead(extension)
                                                  ? "read without its textures and for SDF objects' translucency alone"
                                                  : "not supported and left out"));
}

/// Of used and unused buffers and images; what is no file beneath the folder is left to whoever reads it.
void noteFiles(GltfDocument& document) {
  for (const char* array : {"buffers", "images"}) {
    if (!document.json.contains(array)) continue;
    for (const json& entry : document.json[array])
      if (const auto uri = entry.find("uri"); uri != entry.end())
        if (std::optional<std::filesystem::path> path = fileOfUri(uri->get_ref<const std::string&>(), document.folder))
          document.files.push_back(std::move(*path));
  }
}

void loadBuffers(GltfDocument& document, const GltfContainer& container) {
  if (!document.json.contains("buffers")) return;
  const json buffers = std::move(document.json["buffers"]);
  document.json.erase("buffers");
  document.ownedBytes.reserve(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const json& buffer = buffers[i];
    const std::string element = elementLabel("buffer", i);
    const auto byteLength = buffer["byteLength"].get<std::uint64_t>();
    document.bufferBytes.push_back(byteLength);
    std::optional<std::span<const std::byte>>& bytes = document.buffers.emplace_back();
    if (buffer.contains("uri")) {
      const UriContext context{document.file, element, document.folder, document.limits.fileBytes};
      document.ownedBytes.push_back(readUri(buffer["uri"].get_ref<const std::string&>(), context,
                                            {"application/octet-stream", "application/gltf-buffer"}));
      bytes = document.ownedBytes.back();
    } else if (i == 0 && container.isBinary) {
      if (!container.binaryChunk) document.refuse(element, "has no uri and the GLB has no BIN chunk");
      bytes = *container.binaryChunk;
    }
    if (bytes && bytes->size() < byteLength)
      document.refuse(element, fmt::format("has {} bytes, byteLength says {}", bytes->size(), byteLength));
    // The GLB specification pads the BIN chunk to four bytes; a larger excess means that the lengths disagree.
    if (bytes && !buffer.contains("uri") && bytes->size() > byteLength + 3)
      document.warnings.push_back(
          fmt::format("{}: the BIN chunk is {} bytes longer than byteLength", element, bytes->size() - byteLength));
  }
}

// tinygltf reads typed members from what is left of the JSON: no buffers and no images, so that it opens no file and
// decodes nothing. It refuses index accessors without a view, which the specification allows (all zeros): they get a
// view of their own for the call and lose it again.
void parseWithTinygltf(GltfDocument& document) {
  json stripped = document.json;
  stripped.erase("images");
  const std::size_t viewCount = stripped.contains("bufferViews") ? stripped["bufferViews"].size() : 0;
  if (stripped.contains("accessors")) {
    stripped["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    for (json& accessor : stripped["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = viewCount;
  }
  std::string error, warning;
  bool isLoaded = false;
  document.model = std::make_shared<tinygltf::Model>();
  try {
    const std::string text = stripped.dump();
    if (text.size() > 0xFFFFFFFFu) document.refuse("JSON", "is larger than 4 GiB");
    tinygltf::TinyGLTF loader;
    isLoaded = loader.LoadASCIIFromString(document.model.get(), &error, &warning, text.data(),
                                          static_cast<unsigned int>(text.size()), "");
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) { // its text speaks of the parser's insides
    document.refuse("JSON", "holds a value of another type than glTF asks for");
  }
  if (!isLoaded) document.refuse("JSON", firstLine(error));
  tinygltf::Model& model = *document.model;
  for (tinygltf::Accessor& accessor : model.accessors)
    if (accessor.bufferView == static_cast<int>(viewCount)) accessor.bufferView = -1;
  model.bufferViews.resize(viewCount);
}

} // namespace

void GltfDocument::refuse(std::string_view element, std::string_view reason) const {
  throw BadInput(file, element, reason);
}

void GltfDocument::spendVertices(std::uint64_t count, std::string_view element) {
  if (count > verticesLeft)
    refuse(element,
           fmt::format("the scene has more than {} vertices, keys and instances, the limit", limits.verticesTotal));
  verticesLeft -= count;
}

void GltfDocument::spendIndices(std::uint64_t count, std::string_view element) {
  if (count > indicesLeft)
    refuse(element, fmt::format("the scene has more than {} indices, the limit", limits.indicesTotal));
  indicesLeft -= count;
}

bool GltfDocument::uses(std::string_view extension) const {
  if (!json.contains("extensionsUsed")) return false;
  const auto& used = json["extensionsUsed"];
  return std::any_of(used.begin(), used.end(),
                     [&](const auto& name) { return name.template get_ref<const std::string&>() == extension; });
}

GltfDocument openGltf(std::vector<std::byte> bytes, const std::string& file, const std::filesystem::path& folder,
                      const ImportLimits& limits) {
  GltfDocument document;
  document.file = file;
  document.folder = folder;
  document.limits = limits;
  document.verticesLeft = limits.verticesTotal;
  document.indicesLeft = limits.indicesTotal;
  document.fileBytes = std::move(bytes);
  const GltfContainer container = splitGltfContainer(document.fileBytes, file, document.warnings);
  document.json = parseGuardedJson(container.json, file, limits.jsonDepth);
  checkGltfSchema(document.json, file);
  checkVersions(document);
  checkExtensions(document);
  noteFiles(document);
  loadBuffers(document, container);
  parseWithTinygltf(document);
  return document;
}

std::string firstLine(std::string_view text) { return std::string(text.substr(0, text.find('\n'))); }

} // namespace brickfield
