// Reading and writing whole files. Reads are bounded; writes go beside the target and are renamed, so that a failure or
// Ctrl-C never leaves half a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace brickfield {

/// The bytes of a regular file.
/// error BadInput that names the file: missing, no regular file (a directory, a device), unreadable, over limitBytes
std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t limitBytes = std::uint64_t{4} << 30);

/// Calls `write` with the path of a temporary file in the same folder (with the target's extension), then renames it.
/// Missing parent folders are not made. On any exception the temporary file is removed.
/// error BadInput if the folder is missing or not writable
void writeBesideAndRename(const std::filesystem::path& path,
                          const std::function<void(const std::filesystem::path&)>& write);

/// The same for bytes in memory.
void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFile(const std::filesystem::path& path, std::string_view text);

/// Folder that holds the running executable.
std::filesystem::path executableFolder();

} // namespace brickfield
