// Bounded reads and atomic writes on top of <filesystem>.
#include "core/files.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <unistd.h>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace fs = std::filesystem;

std::vector<std::byte> readFile(const fs::path& path, std::uint64_t limitBytes) {
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  if (!fs::exists(status)) throw BadInput(path.string(), "", "no such file");
  if (!fs::is_regular_file(status)) throw BadInput(path.string(), "", "not a regular file");
  const std::uint64_t bytes = fs::file_size(path, ec);
  if (ec) throw BadInput(path.string(), "", ec.message());
  if (bytes > limitBytes)
    throw BadInput(path.string(), "", fmt::format("{} bytes, at most {} are read", bytes, limitBytes));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw BadInput(path.string(), "", fmt::format("cannot be opened: {}", std::strerror(errno)));
  std::vector<std::byte> content(bytes);
  stream.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(bytes));
  if (static_cast<std::uint64_t>(stream.gcount()) != bytes)
    throw BadInput(path.string(), "", "cannot be read to its end");
  return content;
}

void writeBesideAndRename(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ec;
  if (!fs::is_directory(folder, ec)) throw BadInput(path.string(), "", "its folder does not exist");
  if (!path.has_filename() || fs::is_directory(path, ec))
    throw BadInput(path.string(), "", "names a folder, not a file");
  if (::access(folder.c_str(), W_OK) != 0) throw BadInput(path.string(), "", "its folder cannot be written");
  // A device such as /dev/null is written in place: renaming over it would replace it.
  if (fs::exists(path, ec) && !fs::is_regular_file(path, ec)) return write(path);
  static std::atomic<unsigned> serial{0};
  const fs::path beside =
      folder / fmt::format(".{}.{}.{}{}", path.stem().string(), ::getpid(), serial++, path.extension().string());
  try {
    write(beside);
    fs::rename(beside, path);
  } catch (const fs::filesystem_error& error) {
    fs::remove(beside, ec);
    throw BadInput(path.string(), "", error.code().message());
  } catch (...) {
    fs::remove(beside, ec);
    throw;
  }
}

void writeFile(const fs::path& path, std::span<const std::byte> bytes) {
  writeBesideAndRename(path, [&](const fs::path& beside) {
    std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.flush();
    if (!stream) throw BadInput(path.string(), "", fmt::format("cannot be written: {}", std::strerror(errno)));
  });
}

void writeFile(const fs::path& path, std::string_view text) {
  writeFile(path, std::as_bytes(std::span(text.data(), text.size())));
}

fs::path executableFolder() {
  std::error_code ec;
  const fs::path self = fs::read_symlink("/proc/self/exe", ec);
  return ec ? fs::path(".") : self.parent_path();
}

} // namespace brickfield
