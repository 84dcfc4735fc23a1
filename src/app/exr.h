// OpenImageIO's door: parts of float channels to EXR and back, and stored PNG. The only files that know the library are
// exr.cpp and, for builds without it, exr_absent.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/math.h"

namespace brickfield {

/// One part of a file: interleaved values, rows from the top.
struct ImagePart {
  std::string name;
  glm::uvec2 size{0};
  std::vector<std::string> channels;
  std::vector<float> values; ///< size.x * size.y * channels.size()
};

/// error BadInput that names the path where this build has no OpenImageIO
void requireExr(const std::filesystem::path& path);

/// All parts as 32-bit float, zip-compressed, in this order. Writes beside and renames; the same parts give the same
/// bytes. error BadInput: cannot be written
void writeExrParts(const std::filesystem::path& path, const std::vector<ImagePart>& parts);

/// Every part of an EXR file.
/// error BadInput: not an EXR, damaged, deep, over kLargestImageSide, more than 64 parts or 64 channels
std::vector<ImagePart> readExrParts(const std::filesystem::path& path);

/// The one part of a PNG, values 0 to 1 as stored.
ImagePart readPngPart(const std::filesystem::path& path);

} // namespace brickfield
