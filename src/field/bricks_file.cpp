// .bricks files: arrays to zstd chunks and back. Header and index are bricks_index.h's.
#include "field/bricks_file.h"

#include <memory>

#include <fmt/format.h>
#include <zstd.h>

#include "core/error.h"
#include "core/files.h"
#include "core/hash.h"
#include "field/bricks_index.h"

namespace brickfield {

namespace {

// Level 3 is zstd's own default: within a few per cent of the size of higher ones here, at several times their speed.
constexpr int kCompressionLevel = 3;

std::vector<std::byte> compressChunk(ZSTD_CCtx* context, std::span<const std::byte> array) {
  std::vector<std::byte> packed(ZSTD_compressBound(array.size()));
  const std::size_t bytes =
      ZSTD_compressCCtx(context, packed.data(), packed.size(), array.data(), array.size(), kCompressionLevel);
  if (ZSTD_isError(bytes)) throw Failure(fmt::format("zstd: {}", ZSTD_getErrorName(bytes)));
  packed.resize(bytes);
  return packed;
}

LevelEntry entryOf(const BrickLevel& level) {
  LevelEntry entry;
  entry.voxelSizeObject = level.voxelSizeObject;
  entry.brickCounts = level.brickCounts;
  entry.rangeVoxels = level.rangeVoxels;
  entry.format = level.format;
  entry.brickCount = level.brickCount();
  entry.hasAttributes = !level.baseColor.empty();
  entry.hasEmission = !level.emission.empty();
  return entry;
}

std::span<const std::byte> arrayOf(const BrickLevel& level, ChunkKind kind) {
  switch (kind) {
  case ChunkKind::Indirection:
    return std::as_bytes(std::span(level.indirection));
  case ChunkKind::Distances:
    return level.distances;
  case ChunkKind::BaseColor:
    return std::as_bytes(std::span(level.baseColor));
  case ChunkKind::Material:
    return std::as_bytes(std::span(level.material));
  case ChunkKind::Emission:
    return std::as_bytes(std::span(level.emission));
  }
  return {};
}

// Unpacks one chunk into an array whose size the index has fixed and checked; zstd never writes beyond it.
template <typename Element>
void unpackChunk(std::span<const std::byte> file, const LevelEntry& level, ChunkKind kind,
                 const std::pair<const std::string&, std::string>& nameAndLevel, std::vector<Element>& array) {
  if (!level.hasChunk(kind)) return;
  const auto refuse = [&](std::string_view reason) {
    throw BadInput(nameAndLevel.first, fmt::format("{} {}", nameAndLevel.second, chunkName(kind)), reason);
  };
  const ChunkEntry& chunk = level.chunks[static_cast<std::size_t>(kind)];
  const auto packed = file.subspan(chunk.offset, chunk.compressedBytes);
  if (hash64(packed) != chunk.checksum) refuse("the checksum does not match: the file is damaged");
  const std::uint64_t bytes = level.arrayBytes(kind);
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != bytes)
    refuse(fmt::format("does not unpack to the {} bytes that the index implies", bytes));
  if (ZSTD_findFrameCompressedSize(packed.data(), packed.size()) != packed.size())
    refuse("is not exactly one zstd frame");
  array.resize(bytes / sizeof(Element));
  const std::size_t unpacked = ZSTD_decompress(array.data(), bytes, packed.data(), packed.size());
  if (ZSTD_isError(unpacked)) refuse(fmt::format("zstd: {}", ZSTD_getErrorName(unpacked)));
  if (unpacked != bytes) refuse(fmt::format("unpacks to {} bytes instead of {}", unpacked, bytes));
}

BrickLevel unpackLevel(std::span<const std::byte> file, const LevelEntry& entry, const std::string& name,
                       std::size_t levelIndex) {
  BrickLevel level;
  level.voxelSizeObject = entry.voxelSizeObject;
  level.brickCounts = entry.brickCounts;
  level.rangeVoxels = entry.rangeVoxels;
  level.format = entry.format;
  const std::pair<const std::string&, std::string> nameAndLevel{name, fmt::format("level {}", levelIndex)};
  unpackChunk(file, entry, ChunkKind::Indirection, nameAndLevel, level.indirection);
  unpackChunk(file, entry, ChunkKind::Distances, nameAndLevel, level.distances);
  unpackChunk(file, entry, ChunkKind::BaseColor, nameAndLevel, level.baseColor);
  unpackChunk(file, entry, ChunkKind::Material, nameAndLevel, level.material);
  unpackChunk(file, entry, ChunkKind::Emission, nameAndLevel, level.emission);
  return level;
}

} // namespace

std::vector<std::byte> encodeBricks(const BrickField& field) {
  if (const std::string wrong = validateField(field); !wrong.empty()) throw BadInput("brick field", "", wrong);
  BricksIndex index;
  index.boundsObject = field.boundsObject;
  index.originObject = field.originObject;
  index.sourceHash = field.sourceHash;
  index.thinParts = field.thinParts;
  const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!context) throw Failure("zstd: out of memory");

  std::vector<std::byte> chunks;
  const std::size_t chunksBegin = bricksIndexBytes(field.levels.size());
  for (auto level = field.levels.rbegin(); level != field.levels.rend(); ++level) {
    LevelEntry entry = entryOf(*level);
    for (std::size_t k = 0; k < kChunkKinds; ++k) {
      const auto kind = static_cast<ChunkKind>(k);
      if (!entry.hasChunk(kind)) continue;
      const std::vector<std::byte> packed = compressChunk(context.get(), arrayOf(*level, kind));
      entry.chunks[k] = {chunksBegin + chunks.size(), packed.size(), hash64(packed)};
      chunks.insert(chunks.end(), packed.begin(), packed.end());
    }
    index.levels.push_back(entry);
  }
  index.fileBytes = chunksBegin + chunks.size();
  std::vector<std::byte> file = encodeBricksIndex(index);
  file.insert(file.end(), chunks.begin(), chunks.end());
  return file;
}

BrickField decodeBricks(std::span<const std::byte> bytes, const std::string& name) {
  const BricksIndex index = decodeBricksIndex(bytes, name);
  BrickField field;
  field.boundsObject = index.boundsObject;
  field.originObject = index.originObject;
  field.sourceHash = index.sourceHash;
  field.thinParts = index.thinParts;
  field.levels.resize(index.levels.size());
  for (std::size_t i = 0; i < index.levels.size(); ++i) {
    const std::size_t levelIndex = index.levels.size() - 1 - i;
    field.levels[levelIndex] = unpackLevel(bytes, index.levels[i], name, levelIndex);
  }
  if (const std::string wrong = validateField(field); !wrong.empty()) throw BadInput(name, "", wrong);
  return field;
}

BrickField readBricksFile(const std::filesystem::path& path) { return decodeBricks(readFile(path), path.string()); }

void writeBricksFile(const std::filesystem::path& path, const BrickField& field) {
  if (const std::string wrong = validateField(field); !wrong.empty()) throw BadInput(path.string(), "", wrong);
  writeFile(path, encodeBricks(field));
}

} // namespace brickfield
