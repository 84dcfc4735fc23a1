// A reader of our own for Radiance files: that of stb 2.27, which Debian 12 has, never ends on a truncated run.
#include "app/environment_io.h"

#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include "app/exr.h"
#include "app/image.h"
#include "app/image_io.h"
#include "core/error.h"
#include "core/files.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

constexpr glm::uvec2 kLargestEnvironment{kLargestImageSide, kLargestImageSide / 2};
constexpr float kMostRadiance = 1e12f;
constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 30;

/// Walks the bytes of a picture; every read is checked.
class HdrReader {
public:
  HdrReader(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Environment read() {
    const glm::uvec2 size = readHeader();
    Environment environment{size, {}};
    // A run codes at most 127 pixels of one channel in two bytes: less than this cannot hold the picture.
    const std::uint64_t fewestBytes = std::uint64_t{size.y} * (size.x / 127 + 1);
    if (bytes_.size() - position_ < fewestBytes) throw refuse("is truncated");
    environment.radiance.reserve(std::size_t{size.x} * size.y);
    std::vector<std::uint8_t> line(std::size_t{size.x} * 4);
    for (std::uint32_t y = 0; y < size.y; ++y) {
      readLine(line, size.x);
      for (std::uint32_t x = 0; x < size.x; ++x) environment.radiance.push_back(radianceOf(&line[std::size_t{x} * 4]));
    }
    return environment;
  }

private:
  BadInput refuse(std::string_view reason) const { return BadInput(name_, "", reason); }

  std::uint8_t next() {
    if (position_ >= bytes_.size()) throw refuse("is truncated");
    return std::to_integer<std::uint8_t>(bytes_[position_++]);
  }

  std::string nextTextLine() {
    constexpr std::size_t kLongestLine = 4096;
    std::string line;
    for (char c; (c = static_cast<char>(next())) != '\n';) {
      if (line.size() == kLongestLine) throw refuse("is not a Radiance picture: endless header line");
      line += c;
    }
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  glm::uvec2 readHeader() {
    constexpr int kMostLines = 1000;
    if (nextTextLine().substr(0, 2) != "#?") throw refuse("is not a Radiance picture: does not begin with \"#?\"");
    bool isRgbe = false;
    for (int lines = 0;; ++lines) {
      if (lines == kMostLines) throw refuse("is not a Radiance picture: endless header");
      const std::string line = nextTextLine();
      if (line.empty()) break;
      if (line == "FORMAT=32-bit_rle_rgbe") isRgbe = true;
      if (line == "FORMAT=32-bit_rle_xyze") throw refuse("holds XYZE colours; only RGBE is read");
    }
    if (!isRgbe) throw refuse("names no FORMAT=32-bit_rle_rgbe");
    return sizeOf(nextTextLine());
  }

  glm::uvec2 sizeOf(const std::string& line) const {
    const std::string_view text = line;
    glm::uvec2 size{0};
    const std::size_t middle = text.find(" +X ");
    if (text.substr(0, 3) != "-Y " || middle == std::string_view::npos)
      throw refuse(fmt::format("is not in \"-Y height +X width\" order: \"{}\"", line));
    const char* end = text.data() + text.size();
    const auto height = std::from_chars(text.data() + 3, text.data() + middle, size.y);
    const auto width = std::from_chars(text.data() + middle + 4, end, size.x);
    if (height.ec != std::errc() || height.ptr != text.data() + middle || width.ec != std::errc() || width.ptr != end)
      throw refuse(fmt::format("has no size in \"{}\"", line));
    if (size.x < 1 || size.y < 1 || size.x > kLargestEnvironment.x || size.y > kLargestEnvironment.y)
      throw refuse(fmt::format("{} x {} pixels, from 1 x 1 to {} x {} are read", size.x, size.y, kLargestEnvironment.x,
                               kLargestEnvironment.y));
    return size;
  }

  void readLine(std::vector<std::uint8_t>& line, std::uint32_t width) {
    constexpr std::uint32_t kLeastRunWidth = 8, kMostRunWidth = 0x7fff;
    std::uint8_t first[4] = {next(), next(), next(), next()};
    const bool isRunCoded =
        width >= kLeastRunWidth && width <= kMostRunWidth && first[0] == 2 && first[1] == 2 && (first[2] & 0x80) == 0;
    if (!isRunCoded) {
      std::copy(first, first + 4, line.begin());
      for (std::size_t i = 4; i < line.size(); ++i) line[i] = next();
      return;
    }
    if ((first[2] << 8 | first[3]) != static_cast<int>(width)) throw refuse("a line's width is not the picture's");
    for (std::uint32_t channel = 0; channel < 4; ++channel) {
      for (std::uint32_t x = 0; x < width;) {
        const std::uint8_t code = next();
        const bool isRun = code > 128;
        const std::uint32_t count = isRun ? code - 128u : code;
        if (count == 0 || count > width - x) throw refuse("a run leaves its line");
        const std::uint8_t repeated = isRun ? next() : std::uint8_t{0};
        for (std::uint32_t i = 0; i < count; ++i, ++x) line[std::size_t{x} * 4 + channel] = isRun ? repeated : next();
      }
    }
  }

  static glm::vec3 radianceOf(const std::uint8_t* rgbe) {
    if (rgbe[3] == 0) return glm::vec3(0.0f);
    // Mantissas are fractions of 256 and the exponent is biased by 128.
    const float scale = std::ldexp(1.0f, static_cast<int>(rgbe[3]) - (128 + 8));
    return glm::vec3(rgbe[0], rgbe[1], rgbe[2]) * scale;
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::size_t position_ = 0;
};

Environment environmentOf(const ImagePart& part, const fs::path& path) {
  const std::size_t channels = part.channels.size();
  if (channels < 3) throw BadInput(path.string(), "", "has fewer than three channels");
  Environment environment{part.size, std::vector<glm::vec3>(std::size_t{part.size.x} * part.size.y)};
  for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
    const float* value = &part.values[i * channels];
    environment.radiance[i] = {value[0], value[1], value[2]};
  }
  return environment;
}

} // namespace

Environment decodeRadianceHdr(std::span<const std::byte> bytes, const std::string& name) {
  return HdrReader(bytes, name).read();
}

Environment readEnvironment(const fs::path& path) {
  checkInputPath(path, {".hdr", ".exr"});
  Environment environment = extensionOf(path) == ".hdr"
                                ? decodeRadianceHdr(readFile(path, kMostFileBytes), path.string())
                                : environmentOf(readExrParts(path).front(), path);
  if (environment.size.x != 2 * environment.size.y)
    throw BadInput(path.string(), "",
                   fmt::format("{} x {} pixels: an equirectangular image is twice as wide as high", environment.size.x,
                               environment.size.y));
  if (environment.size.x > kLargestEnvironment.x)
    throw BadInput(path.string(), "", fmt::format("more than {} pixels wide", kLargestEnvironment.x));
  for (std::size_t i = 0; i < environment.radiance.size(); ++i) {
    glm::vec3& radiance = environment.radiance[i];
    if (!isFinite(radiance) || glm::any(glm::greaterThan(radiance, glm::vec3(kMostRadiance))))
      throw BadInput(path.string(), fmt::format("pixel {},{}", i % environment.size.x, i / environment.size.x),
                     fmt::format("radiance is not finite or beyond {:g}", kMostRadiance));
    radiance = glm::max(radiance, glm::vec3(0.0f));
  }
  return environment;
}

} // namespace brickfield
