// Pictures to and from files: PNG (8 bits, sRGB) through stb, EXR (float, linear) through OpenImageIO where the build
// has it. Layers of a frame are in layers_io.h, environments in environment_io.h.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/image.h"

namespace brickfield {

/// Lower-case extension with its dot: ".png".
std::string extensionOf(const std::filesystem::path& path);

/// Refuses a path that cannot be written, before any long work: wrong extension, folder missing or not writable, a
/// folder itself, EXR in a build without it.
///
/// flag       names the path's origin in the message ("-o")
/// extensions accepted ones, with dots
/// error      BadInput that names the path
void checkOutputPath(const std::filesystem::path& path, std::string_view flag,
                     const std::vector<std::string>& extensions);

/// The same for an input: exists, is a regular file, has one of the extensions (none given: any).
void checkInputPath(const std::filesystem::path& path, const std::vector<std::string>& extensions = {});

/// display sRGB-coded values, clamped to [0,1] and rounded to 8 bits. Writes beside and renames.
void writePng(const std::filesystem::path& path, const RgbImage& display);

/// radiance linear; float channels R, G, B. error BadInput in a build without OpenImageIO
void writeExr(const std::filesystem::path& path, const RgbImage& radiance);

/// By extension: .png through exposure and tone curve, .exr as it is.
void writePicture(const std::filesystem::path& path, const RgbImage& radiance, float exposureEv);

/// A stored PNG: values 0 to 1 as coded, grey spread to RGB, alpha left out.
/// error BadInput: not a PNG, damaged, over kLargestImageSide; a build without OpenImageIO
RgbImage readPng(const std::filesystem::path& path);

} // namespace brickfield
