// PNG goes through stb in every build, so that both builds write the same file; reading and EXR go through exr.h.
#include "app/image_io.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include "app/exr.h"
#include "app/tone_curve.h"
#include "core/error.h"
#include "core/files.h"

namespace brickfield {

namespace fs = std::filesystem;

std::string extensionOf(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

namespace {

void checkExtension(const fs::path& path, std::string_view flag, const std::vector<std::string>& extensions) {
  const std::string extension = extensionOf(path);
  if (extensions.empty() || std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return;
  throw BadInput(path.string(), flag,
                 extension.empty()
                     ? fmt::format("has no extension, expected {}", fmt::join(extensions, " or "))
                     : fmt::format("unknown extension \"{}\", expected {}", extension, fmt::join(extensions, " or ")));
}

} // namespace

void checkOutputPath(const fs::path& path, std::string_view flag, const std::vector<std::string>& extensions) {
  if (path.empty()) throw BadInput(flag, "", "names no file");
  std::error_code ec;
  if (fs::is_directory(path, ec)) throw BadInput(path.string(), flag, "names a folder, not a file");
  // Devices have no extension to choose a format by; they take the first.
  const bool isDevice = path.extension().empty() && isWrittenInPlace(path);
  if (!isDevice) checkExtension(path, flag, extensions);
  if (isDevice ? extensions == std::vector<std::string>{".exr"} : extensionOf(path) == ".exr") requireExr(path);
  if (const std::string obstacle = obstacleToWriting(path); !obstacle.empty())
    throw BadInput(path.string(), flag, obstacle);
}

void checkInputPath(const fs::path& path, const std::vector<std::string>& extensions) {
  if (const std::string obstacle = obstacleToReading(path); !obstacle.empty())
    throw BadInput(path.string(), "", obstacle);
  checkExtension(path, "", extensions);
}

void writePng(const fs::path& path, const RgbImage& display) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(display.pixels.size() * 3);
  for (const glm::vec3& pixel : display.pixels)
    for (int c = 0; c < 3; ++c) {
      // Written so that NaN ends at 0.
      const float unit = pixel[c] > 0.0f ? std::min(pixel[c], 1.0f) : 0.0f;
      bytes.push_back(static_cast<std::uint8_t>(std::lround(unit * 255.0f)));
    }
  const int width = static_cast<int>(display.size.x), height = static_cast<int>(display.size.y);
  std::vector<std::byte> file;
  const auto append = [](void* context, void* chunk, int size) {
    const std::byte* first = static_cast<const std::byte*>(chunk);
    auto& target = *static_cast<std::vector<std::byte>*>(context);
    target.insert(target.end(), first, first + size);
  };
  if (!stbi_write_png_to_func(append, &file, width, height, 3, bytes.data(), width * 3))
    throw Failure(fmt::format("{}: cannot be encoded as PNG", path.string()));
  writeFile(path, file);
}

void writeExr(const fs::path& path, const RgbImage& radiance) {
  ImagePart part{"", radiance.size, {"R", "G", "B"}, {}};
  part.values.reserve(radiance.pixels.size() * 3);
  for (const glm::vec3& pixel : radiance.pixels) part.values.insert(part.values.end(), {pixel.x, pixel.y, pixel.z});
  writeExrParts(path, {part});
}

RgbImage readPng(const fs::path& path) {
  const ImagePart part = readPngPart(path);
  const std::size_t channels = part.channels.size();
  RgbImage image{part.size, std::vector<glm::vec3>(std::size_t{part.size.x} * part.size.y)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float* value = &part.values[i * channels];
    image.pixels[i] = channels < 3 ? glm::vec3(value[0]) : glm::vec3(value[0], value[1], value[2]);
  }
  return image;
}

void writePicture(const fs::path& path, const RgbImage& radiance, float exposureEv) {
  if (extensionOf(path) == ".exr") return writeExr(path, radiance);
  RgbImage display{radiance.size, {}};
  display.pixels.reserve(radiance.pixels.size());
  for (const glm::vec3& pixel : radiance.pixels) display.pixels.push_back(displayFromRadiance(pixel, exposureEv));
  writePng(path, display);
}

} // namespace brickfield
