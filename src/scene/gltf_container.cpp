// GLB as in section 4 of the glTF 2.0 specification: 12 bytes of header, then chunks of length, type and payload.
#include "scene/gltf_container.h"

#include <cctype>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kMagic = 0x46546C67;       // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;   // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942; // "BIN\0"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t littleEndian32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

bool isNamedGlb(std::string_view file) {
  if (file.size() < 4) return false;
  std::string ending(file.substr(file.size() - 4));
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".glb";
}

} // namespace

GltfContainer splitGltfContainer(std::span<const std::byte> bytes, std::string_view file,
                                 std::vector<std::string>& warnings) {
  const auto refuse = [&](std::string_view reason) { throw BadInput(file, "GLB", reason); };
  GltfContainer container;
  if (bytes.size() < 4 || littleEndian32(bytes, 0) != kMagic) {
    if (isNamedGlb(file)) refuse("does not start with \"glTF\"");
    container.json = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    return container;
  }
  container.isBinary = true;
  if (bytes.size() < kHeaderBytes) refuse("ends inside its header");
  if (const std::uint32_t version = littleEndian32(bytes, 4); version != 2)
    refuse(fmt::format("container version {}, only 2 is known", version));
  const std::size_t length = littleEndian32(bytes, 8);
  if (length > bytes.size()) refuse(fmt::format("header says {} bytes, the file has {}", length, bytes.size()));
  if (length < kHeaderBytes + kChunkHeaderBytes)
    refuse(fmt::format("header says {} bytes, too few for a chunk", length));
  if (length < bytes.size())
    warnings.push_back(fmt::format("GLB: {} bytes behind its end are left out", bytes.size() - length));

  bool hasJson = false;
  int chunkIndex = 0;
  for (std::size_t offset = kHeaderBytes; offset < length; ++chunkIndex) {
    if (length - offset < kChunkHeaderBytes) refuse(fmt::format("ends inside the header of chunk {}", chunkIndex));
    const std::size_t chunkBytes = littleEndian32(bytes, offset);
    const std::uint32_t type = littleEndian32(bytes, offset + 4);
    offset += kChunkHeaderBytes;
    if (chunkBytes > length - offset)
      refuse(fmt::format("chunk {} says {} bytes, {} are left", chunkIndex, chunkBytes, length - offset));
    if (chunkBytes % 4 != 0) refuse(fmt::format("chunk {} has {} bytes, not a multiple of 4", chunkIndex, chunkBytes));
    if ((chunkIndex == 0) != (type == kJsonChunk))
      refuse(chunkIndex == 0 ? "the first chunk is not JSON" : "has more than one JSON chunk");
    const std::span<const std::byte> payload = bytes.subspan(offset, chunkBytes);
    if (type == kJsonChunk) {
      if (payload.empty()) refuse("the JSON chunk is empty");
      container.json = {reinterpret_cast<const char*>(payload.data()), payload.size()};
      hasJson = true;
    } else if (type == kBinaryChunk) {
      if (container.binaryChunk) refuse("has more than one BIN chunk");
      if (chunkIndex != 1) refuse("the BIN chunk is not the second one");
      container.binaryChunk = payload;
    } else {
      warnings.push_back(fmt::format("GLB: chunk {} of unknown type {:#010x} is left out", chunkIndex, type));
    }
    offset += chunkBytes;
  }
  if (!hasJson) refuse("has no JSON chunk");
  return container;
}

} // namespace brickfield
