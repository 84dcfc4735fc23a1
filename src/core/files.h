// Reading and writing whole files. Reads are bounded and never wait; writes go beside the target and are renamed, so
// that a failure or Ctrl-C never leaves half a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brickfield {

/// The bytes of a regular file. What would block or never end (named pipe, socket, device) is refused unopened.
///
/// shownAs  the file's name in messages; empty: the path
/// error    BadInput that names the file: missing, no regular file, unreadable, over limitBytes
/// proved by tests/unit/core/files_test.cpp
std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t limitBytes = std::uint64_t{4} << 30,
                                std::string_view shownAs = {});

/// Calls `write` with the path of a temporary file in the same folder (with the target's extension), then renames it.
/// A symbolic link keeps its place: what it leads to is replaced. Missing parent folders are not made. On any exception
/// the temporary file is removed. Two kinds of target are written in place, because renaming would replace them: a
/// character device (/dev/null, a terminal) and whatever is this process's standard output (/dev/stdout); for them
/// `write` fills a file in the system's temporary folder, whose bytes are copied then.
///
/// error BadInput that names the target: folder missing or not writable; a folder, named pipe, socket or block device
/// proved by tests/unit/core/files_test.cpp
void writeBesideAndRename(const std::filesystem::path& path,
                          const std::function<void(const std::filesystem::path&)>& write);

/// The same for bytes in memory.
void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFile(const std::filesystem::path& path, std::string_view text);

/// What keeps a file from being read, found without opening it. Empty: nothing.
std::string obstacleToReading(const std::filesystem::path& path);

/// What keeps a file from being written there, found by making and removing a file beside it: worth asking before long
/// work. Empty: nothing.
std::string obstacleToWriting(const std::filesystem::path& path);

/// A character device or this process's standard output: written in place, and by several at once.
bool isWrittenInPlace(const std::filesystem::path& path);

/// Folder that holds the running executable.
std::filesystem::path executableFolder();

} // namespace brickfield
