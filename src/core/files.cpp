// Bounded reads and atomic writes: POSIX calls where <filesystem> cannot say what a path leads to.
#include "core/files.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

class Descriptor {
public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool isOpen() const { return number_ >= 0; }
  int number() const { return number_; }

private:
  int number_;
};

const char* kindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a named pipe";
  if (S_ISSOCK(mode)) return "a socket";
  if (S_ISBLK(mode)) return "a block device";
  if (S_ISCHR(mode)) return "a character device";
  return "something unknown";
}

std::string obstacleToReading(int statError, const struct stat& status) {
  if (statError == ENOENT || statError == ENOTDIR) return "no such file";
  if (statError != 0) return fmt::format("cannot be opened: {}", std::strerror(statError));
  if (!S_ISREG(status.st_mode)) return fmt::format("is {}, not a regular file", kindOf(status.st_mode));
  return "";
}

bool isOwnOutput(const struct stat& status) {
  struct stat own {};
  return ::fstat(STDOUT_FILENO, &own) == 0 && own.st_dev == status.st_dev && own.st_ino == status.st_ino;
}

/// The file that is replaced: behind a symbolic link, if there is one that leads somewhere.
fs::path replacedFile(const fs::path& path) {
  std::error_code ec;
  if (!fs::is_symlink(path, ec)) return path;
  const fs::path target = fs::canonical(path, ec);
  return ec ? path : target;
}

fs::path folderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// A short name of its own, so that a long one of the target's still fits; other processes and threads have others.
fs::path temporaryFor(const fs::path& target, bool isInPlace) {
  std::error_code ec;
  const fs::path folder = isInPlace ? fs::temp_directory_path(ec) : folderOf(target);
  static std::atomic<unsigned> serial{0};
  return folder / fmt::format(".brickfield-{}-{}{}", ::getpid(), serial++, target.extension().string());
}

/// What keeps the path from being written, as far as looking at it tells; empty: nothing.
std::string visibleObstacle(const fs::path& path) {
  std::error_code ec;
  struct stat status {};
  if (!path.has_filename()) return "names a folder, not a file";
  if (::stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return "names a folder, not a file";
    if (!S_ISREG(status.st_mode) && !isWrittenInPlace(path))
      return fmt::format("is {}, which is not written to", kindOf(status.st_mode));
    return "";
  }
  const int error = errno;
  if (!fs::is_directory(folderOf(path), ec)) return "its folder does not exist";
  if (error != ENOENT) return fmt::format("cannot be written: {}", std::strerror(error));
  return "";
}

/// Opened without waiting for what may be at the other end of a device; written to as usual.
int openInPlace(const fs::path& target) {
  struct stat status {};
  if (::stat(target.c_str(), &status) == 0 && isOwnOutput(status)) return ::dup(STDOUT_FILENO);
  const int number = ::open(target.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (number >= 0) ::fcntl(number, F_SETFL, 0);
  return number;
}

void copyInPlace(const fs::path& source, const fs::path& target) {
  const std::vector<std::byte> bytes = readFile(source);
  std::fflush(stdout); // what was printed before comes before
  const Descriptor place(openInPlace(target));
  const auto refuse = [&] {
    throw BadInput(target.string(), "", fmt::format("cannot be written: {}", std::strerror(errno)));
  };
  if (!place.isOpen()) refuse();
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(place.number(), bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse();
    done += static_cast<std::size_t>(written);
  }
}

} // namespace

std::string obstacleToReading(const fs::path& path) {
  struct stat status {};
  if (std::string obstacle = obstacleToReading(::stat(path.c_str(), &status) == 0 ? 0 : errno, status);
      !obstacle.empty())
    return obstacle;
  return ::access(path.c_str(), R_OK) == 0 ? "" : fmt::format("cannot be opened: {}", std::strerror(errno));
}

std::vector<std::byte> readFile(const fs::path& path, std::uint64_t limitBytes, std::string_view shownAs) {
  const std::string name = shownAs.empty() ? path.string() : std::string(shownAs);
  const auto refuse = [&](const std::string& reason) {
    if (!reason.empty()) throw BadInput(name, "", reason);
  };
  struct stat status {};
  // Asked by name first, since opening alone may rewind a tape or wake a pipe's other end; then of what was opened,
  // since the name may lead elsewhere by then.
  refuse(obstacleToReading(path));
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!file.isOpen()) refuse(fmt::format("cannot be opened: {}", std::strerror(errno)));
  refuse(obstacleToReading(::fstat(file.number(), &status) == 0 ? 0 : errno, status));
  const auto bytes = static_cast<std::uint64_t>(status.st_size);
  if (bytes > limitBytes) refuse(fmt::format("{} bytes, at most {} are read", bytes, limitBytes));
  std::vector<std::byte> content(bytes);
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t count = ::read(file.number(), content.data() + done, content.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(fmt::format("cannot be read: {}", std::strerror(errno)));
    if (count == 0) refuse("cannot be read to its end");
    done += static_cast<std::size_t>(count);
  }
  return content;
}

void writeBesideAndRename(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  if (const std::string obstacle = visibleObstacle(path); !obstacle.empty())
    throw BadInput(path.string(), "", obstacle);
  const bool isInPlace = isWrittenInPlace(path);
  const fs::path target = replacedFile(path);
  std::error_code ec;
  if (!isInPlace && ::access(folderOf(target).c_str(), W_OK) != 0)
    throw BadInput(path.string(), "", "its folder cannot be written");
  const fs::path beside = temporaryFor(target, isInPlace);
  try {
    write(beside);
    if (isInPlace) {
      copyInPlace(beside, path);
      fs::remove(beside, ec);
    } else {
      fs::rename(beside, target);
    }
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

std::string obstacleToWriting(const fs::path& path) {
  if (std::string obstacle = visibleObstacle(path); !obstacle.empty()) return obstacle;
  if (isWrittenInPlace(path)) return "";
  const fs::path target = replacedFile(path);
  const fs::path probe = temporaryFor(target, false);
  if (!Descriptor(::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)).isOpen())
    return fmt::format("its folder cannot be written: {}", std::strerror(errno));
  ::unlink(probe.c_str());
  return "";
}

bool isWrittenInPlace(const fs::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && (S_ISCHR(status.st_mode) || isOwnOutput(status));
}

fs::path executableFolder() {
  std::error_code ec;
  const fs::path self = fs::read_symlink("/proc/self/exe", ec);
  return ec ? fs::path(".") : self.parent_path();
}

} // namespace brickfield
