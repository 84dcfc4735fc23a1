// The .bricks file: one BrickField on disk. Little-endian header with magic, version, settings and source hash, then an
// index of chunks (coarsest level first), each zstd-compressed with an XXH3 checksum of its compressed bytes. Every
// size and offset is checked before it is used.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "field/brick_field.h"

namespace brickfield {

/// error BadInput that names the file and the chunk or header field: not a .bricks file, unknown version, truncated,
/// checksum mismatch, size that does not fit, field that validateField refuses
BrickField readBricksFile(const std::filesystem::path& path);

/// Writes beside the target and renames. The same field gives the same bytes.
void writeBricksFile(const std::filesystem::path& path, const BrickField& field);

/// The same on memory; `name` stands for the file in messages.
BrickField decodeBricks(std::span<const std::byte> bytes, const std::string& name);
std::vector<std::byte> encodeBricks(const BrickField& field);

} // namespace brickfield
