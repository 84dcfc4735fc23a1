// The first part of a .bricks file: header and index, as bytes and back. Private to the file's reader and writer.
//
//   offset  bytes
//        0      8  magic "BRICKFLD"
//        8      4  version, 1
//       12      4  level count L
//       16      8  bytes of the whole file
//       24     16  source hash, high and low
//       40     24  bounds, min and max
//       64     12  origin
//       76      4  thin parts: ten-thousandths of the surface (2), resolution that would do (2)
//       80  152 L  levels, coarsest first:
//                    +0  voxel size (4), brick counts (12), range (4), format (4), brick count (4), attribute bits (4)
//                   +32  five chunks of 24: offset (8), compressed bytes (8), checksum (8); zeros where it is absent
//   80+152L      8  XXH3 of all bytes before
//   88+152L         chunks, without gaps, in the order of the index
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "field/brick_field.h"

namespace brickfield {

inline constexpr std::size_t kChunkKinds = 5;
enum class ChunkKind : std::uint32_t { Indirection, Distances, BaseColor, Material, Emission };
std::string_view chunkName(ChunkKind kind);

struct ChunkEntry {
  std::uint64_t offset = 0;
  std::uint64_t compressedBytes = 0;
  std::uint64_t checksum = 0; ///< XXH3 of the compressed bytes
};

/// One level as the index describes it: what all sizes follow from, before anything is allocated.
struct LevelEntry {
  float voxelSizeObject = 0;
  glm::ivec3 brickCounts{0};
  float rangeVoxels = 0;
  DistanceFormat format = DistanceFormat::R8Snorm;
  std::uint32_t brickCount = 0;
  bool hasAttributes = false;
  bool hasEmission = false;
  std::array<ChunkEntry, kChunkKinds> chunks;

  bool hasChunk(ChunkKind kind) const;
  /// Bytes of the array that a chunk unpacks to; small numbers by the limits that decodeBricksIndex has checked.
  std::uint64_t arrayBytes(ChunkKind kind) const;
};

struct BricksIndex {
  Box boundsObject;
  glm::vec3 originObject{0};
  Hash128 sourceHash;
  ThinParts thinParts;
  std::vector<LevelEntry> levels; ///< coarsest first, as in the file
  std::uint64_t fileBytes = 0;
};

std::size_t bricksIndexBytes(std::size_t levelCount);
std::vector<std::byte> encodeBricksIndex(const BricksIndex& index);

/// Reads and checks header and index: what it returns has counts and sizes within the limits of brick_layout.h, chunks
/// that lie gapless up to the end of the file, and none that could not unpack to its array's size.
/// error BadInput that names the file and the field
BricksIndex decodeBricksIndex(std::span<const std::byte> file, const std::string& name);

} // namespace brickfield
