// Environment images from files: Radiance .hdr in every build, .exr where the build has OpenImageIO.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "scene/lighting.h"

namespace brickfield {

/// Reads an equirectangular environment: linear radiance, rows from the zenith. Negative values become 0.
///
/// error     BadInput that names the file: unknown extension, damaged, truncated, over 16384 x 8192 pixels, not twice
///           as wide as high, a value that is NaN, infinite or beyond 1e12 (its square must fit a float)
/// proved by tests/unit/app/environment_io_test.cpp
Environment readEnvironment(const std::filesystem::path& path);

/// A Radiance picture in memory (RGBE, flat or run-length coded, "-Y H +X W" order); `name` stands for it in messages.
/// source  G. Ward, "Real Pixels", Graphics Gems II, 1991
Environment decodeRadianceHdr(std::span<const std::byte> bytes, const std::string& name);

} // namespace brickfield
