// Header and index of a .bricks file, byte by byte.
#include "field/bricks_index.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "field/brick_layout.h"

namespace brickfield {

static_assert(std::endian::native == std::endian::little, "files are little-endian and copied as they are");

namespace {

constexpr std::string_view kMagic = "BRICKFLD";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kLevelBytes = 32 + kChunkKinds * 24;
constexpr std::size_t kChecksumBytes = 8;
constexpr std::uint32_t kAttributesBit = 1, kEmissionBit = 2;
// zstd makes at most 128 KiB of a block, which has at least 3 bytes of header and 1 of content (RFC 8878, 3.1.1.2). A
// chunk that claims more is refused before memory is taken for it.
constexpr std::uint64_t kMostBytesPerCompressedByte = (128 * 1024) / 4;

class ByteWriter {
public:
  template <typename Value>
  void put(Value value) {
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof(Value));
    std::memcpy(bytes_.data() + at, &value, sizeof(Value));
  }
  void put(glm::vec3 v) { put(v.x), put(v.y), put(v.z); }
  void put(glm::ivec3 v) { put(v.x), put(v.y), put(v.z); }
  std::vector<std::byte> take() { return std::move(bytes_); }
  std::span<const std::byte> bytes() const { return bytes_; }

private:
  std::vector<std::byte> bytes_;
};

// Reads within a span whose size the caller has checked.
class ByteReader {
public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <typename Value>
  Value get() {
    Value value;
    std::memcpy(&value, bytes_.data(), sizeof(Value));
    bytes_ = bytes_.subspan(sizeof(Value));
    return value;
  }
  template <typename Value>
  void get(Value& value) {
    value = get<Value>();
  }
  void get(glm::vec3& v) { get(v.x), get(v.y), get(v.z); }
  void get(glm::ivec3& v) { get(v.x), get(v.y), get(v.z); }

private:
  std::span<const std::byte> bytes_;
};

void putLevel(ByteWriter& writer, const LevelEntry& level) {
  writer.put(level.voxelSizeObject);
  writer.put(level.brickCounts);
  writer.put(level.rangeVoxels);
  writer.put(static_cast<std::uint32_t>(level.format));
  writer.put(level.brickCount);
  writer.put((level.hasAttributes ? kAttributesBit : 0u) | (level.hasEmission ? kEmissionBit : 0u));
  for (const ChunkEntry& chunk : level.chunks) {
    writer.put(chunk.offset);
    writer.put(chunk.compressedBytes);
    writer.put(chunk.checksum);
  }
}

// Sizes that decide about memory are checked here, all else by validateField in the end.
LevelEntry getLevel(ByteReader& reader, const std::string& name, const std::string& element) {
  LevelEntry level;
  reader.get(level.voxelSizeObject);
  reader.get(level.brickCounts);
  reader.get(level.rangeVoxels);
  const auto format = reader.get<std::uint32_t>();
  reader.get(level.brickCount);
  const auto attributes = reader.get<std::uint32_t>();
  for (ChunkEntry& chunk : level.chunks) {
    reader.get(chunk.offset);
    reader.get(chunk.compressedBytes);
    reader.get(chunk.checksum);
  }
  std::uint64_t cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (level.brickCounts[axis] < 1 || level.brickCounts[axis] > kMaxBricksPerAxis)
      throw BadInput(name, element,
                     fmt::format("{} bricks along {} are not from 1 to {}", level.brickCounts[axis], "xyz"[axis],
                                 kMaxBricksPerAxis));
    cells *= static_cast<std::uint64_t>(level.brickCounts[axis]);
  }
  if (cells > kMaxCellsPerLevel)
    throw BadInput(name, element, fmt::format("{} cells are more than {}", cells, kMaxCellsPerLevel));
  if (level.brickCount > cells)
    throw BadInput(name, element, fmt::format("{} bricks for {} cells", level.brickCount, cells));
  if (format > static_cast<std::uint32_t>(DistanceFormat::R16Snorm))
    throw BadInput(name, element, fmt::format("distance format {} is unknown", format));
  level.format = static_cast<DistanceFormat>(format);
  if (attributes != 0 && attributes != kAttributesBit && attributes != (kAttributesBit | kEmissionBit))
    throw BadInput(name, element, fmt::format("attribute bits {} are unknown", attributes));
  level.hasAttributes = (attributes & kAttributesBit) != 0;
  level.hasEmission = (attributes & kEmissionBit) != 0;
  return level;
}

// Chunks follow one another without gaps, so that every byte of the file is under a checksum.
void checkChunks(const BricksIndex& index, const std::string& name) {
  std::uint64_t next = bricksIndexBytes(index.levels.size());
  std::uint64_t unpackedBytes = 0;
  for (std::size_t i = 0; i < index.levels.size(); ++i) {
    const LevelEntry& level = index.levels[i];
    for (std::size_t k = 0; k < kChunkKinds; ++k) {
      const auto kind = static_cast<ChunkKind>(k);
      const ChunkEntry& chunk = level.chunks[k];
      const std::string element = fmt::format("level {} {}", index.levels.size() - 1 - i, chunkName(kind));
      if (!level.hasChunk(kind)) {
        if (chunk.offset != 0 || chunk.compressedBytes != 0 || chunk.checksum != 0)
          throw BadInput(name, element, "there is a chunk that must not be");
        continue;
      }
      if (chunk.offset != next) throw BadInput(name, element, fmt::format("lies at {}, not at {}", chunk.offset, next));
      if (chunk.compressedBytes > index.fileBytes - next)
        throw BadInput(name, element,
                       fmt::format("{} bytes at {} reach beyond the file", chunk.compressedBytes, chunk.offset));
      if (level.arrayBytes(kind) / kMostBytesPerCompressedByte > chunk.compressedBytes)
        throw BadInput(name, element,
                       fmt::format("{} bytes cannot hold the {} that the index implies", chunk.compressedBytes,
                                   level.arrayBytes(kind)));
      next += chunk.compressedBytes;
      unpackedBytes += level.arrayBytes(kind);
    }
  }
  if (next != index.fileBytes)
    throw BadInput(name, "index", fmt::format("chunks end at {}, the file at {}", next, index.fileBytes));
  if (unpackedBytes > kMaxFieldBytes)
    throw BadInput(name, "index", fmt::format("unpacks to {} bytes, more than {}", unpackedBytes, kMaxFieldBytes));
}

} // namespace

std::string_view chunkName(ChunkKind kind) {
  switch (kind) {
  case ChunkKind::Indirection:
    return "indirection";
  case ChunkKind::Distances:
    return "distances";
  case ChunkKind::BaseColor:
    return "base colour";
  case ChunkKind::Material:
    return "material";
  case ChunkKind::Emission:
    return "emission";
  }
  return "unknown";
}

bool LevelEntry::hasChunk(ChunkKind kind) const {
  switch (kind) {
  case ChunkKind::Indirection:
    return true;
  case ChunkKind::Distances:
    return brickCount > 0;
  case ChunkKind::BaseColor:
  case ChunkKind::Material:
    return brickCount > 0 && hasAttributes;
  case ChunkKind::Emission:
    return brickCount > 0 && hasEmission;
  }
  return false;
}

std::uint64_t LevelEntry::arrayBytes(ChunkKind kind) const {
  constexpr std::uint64_t kBytesPerWord = sizeof(std::uint32_t);
  if (!hasChunk(kind)) return 0;
  if (kind == ChunkKind::Indirection)
    return kBytesPerWord * static_cast<std::uint64_t>(brickCounts.x) * static_cast<std::uint64_t>(brickCounts.y) *
           static_cast<std::uint64_t>(brickCounts.z);
  const std::uint64_t samples = std::uint64_t{brickCount} * kBrickSampleCount;
  return samples * (kind == ChunkKind::Distances ? bytesPerSample(format) : kBytesPerWord);
}

std::size_t bricksIndexBytes(std::size_t levelCount) {
  return kHeaderBytes + levelCount * kLevelBytes + kChecksumBytes;
}

std::vector<std::byte> encodeBricksIndex(const BricksIndex& index) {
  ByteWriter writer;
  for (const char c : kMagic) writer.put(c);
  writer.put(kVersion);
  writer.put(static_cast<std::uint32_t>(index.levels.size()));
  writer.put(index.fileBytes);
  writer.put(index.sourceHash.high);
  writer.put(index.sourceHash.low);
  writer.put(index.boundsObject.min);
  writer.put(index.boundsObject.max);
  writer.put(index.originObject);
  writer.put(index.thinParts.perTenThousand);
  writer.put(index.thinParts.resolution);
  for (const LevelEntry& level : index.levels) putLevel(writer, level);
  writer.put(hash64(writer.bytes()));
  return writer.take();
}

BricksIndex decodeBricksIndex(std::span<const std::byte> file, const std::string& name) {
  if (file.size() < kMagic.size() || std::memcmp(file.data(), kMagic.data(), kMagic.size()) != 0)
    throw BadInput(name, "header", "not a .bricks file");
  if (file.size() < kHeaderBytes) throw BadInput(name, "header", "truncated");
  ByteReader reader(file.subspan(kMagic.size()));
  if (const auto version = reader.get<std::uint32_t>(); version != kVersion)
    throw BadInput(name, "header", fmt::format("version {} is unknown, this program reads {}", version, kVersion));
  const auto levelCount = reader.get<std::uint32_t>();
  if (levelCount < 1 || levelCount > static_cast<std::uint32_t>(kMaxLevels))
    throw BadInput(name, "header", fmt::format("{} levels are not from 1 to {}", levelCount, kMaxLevels));
  const std::size_t indexBytes = bricksIndexBytes(levelCount);
  if (file.size() < indexBytes) throw BadInput(name, "index", "truncated");
  ByteReader checksum(file.subspan(indexBytes - kChecksumBytes));
  if (checksum.get<std::uint64_t>() != hash64(file.first(indexBytes - kChecksumBytes)))
    throw BadInput(name, "header and index", "the checksum does not match: the file is damaged");

  BricksIndex index;
  reader.get(index.fileBytes);
  if (index.fileBytes != file.size())
    throw BadInput(name, "header",
                   fmt::format("the file has {} bytes and should have {}: {}", file.size(), index.fileBytes,
                               file.size() < index.fileBytes ? "truncated" : "too long"));
  reader.get(index.sourceHash.high);
  reader.get(index.sourceHash.low);
  reader.get(index.boundsObject.min);
  reader.get(index.boundsObject.max);
  reader.get(index.originObject);
  reader.get(index.thinParts.perTenThousand);
  reader.get(index.thinParts.resolution);
  for (std::uint32_t i = 0; i < levelCount; ++i)
    index.levels.push_back(getLevel(reader, name, fmt::format("level {}", levelCount - 1 - i)));
  checkChunks(index, name);
  return index;
}

} // namespace brickfield
