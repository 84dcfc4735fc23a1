// What every internal format of this room looks like in memory.
#include <fmt/format.h>

#include "core/error.h"
#include "gpu/texture.h"

namespace brickfield {

namespace {

struct KnownFormat {
  GLenum internalFormat;
  PixelLayout layout;
};

constexpr KnownFormat kKnownFormats[] = {
    // normalized
    {GL_R8, {GL_RED, GL_UNSIGNED_BYTE, 1, 1, false, false}},
    {GL_RG8, {GL_RG, GL_UNSIGNED_BYTE, 2, 2, false, false}},
    {GL_RGB8, {GL_RGB, GL_UNSIGNED_BYTE, 3, 3, false, false}},
    {GL_RGBA8, {GL_RGBA, GL_UNSIGNED_BYTE, 4, 4, false, false}},
    {GL_SRGB8, {GL_RGB, GL_UNSIGNED_BYTE, 3, 3, false, false}},
    {GL_SRGB8_ALPHA8, {GL_RGBA, GL_UNSIGNED_BYTE, 4, 4, false, false}},
    {GL_R8_SNORM, {GL_RED, GL_BYTE, 1, 1, false, false}},
    {GL_RG8_SNORM, {GL_RG, GL_BYTE, 2, 2, false, false}},
    {GL_RGBA8_SNORM, {GL_RGBA, GL_BYTE, 4, 4, false, false}},
    {GL_R16, {GL_RED, GL_UNSIGNED_SHORT, 1, 2, false, false}},
    {GL_RG16, {GL_RG, GL_UNSIGNED_SHORT, 2, 4, false, false}},
    {GL_RGBA16, {GL_RGBA, GL_UNSIGNED_SHORT, 4, 8, false, false}},
    {GL_R16_SNORM, {GL_RED, GL_SHORT, 1, 2, false, false}},
    {GL_RG16_SNORM, {GL_RG, GL_SHORT, 2, 4, false, false}},
    {GL_RGBA16_SNORM, {GL_RGBA, GL_SHORT, 4, 8, false, false}},
    {GL_RGB10_A2, {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, 4, 4, false, false}},
    // float
    {GL_R16F, {GL_RED, GL_HALF_FLOAT, 1, 2, false, false}},
    {GL_RG16F, {GL_RG, GL_HALF_FLOAT, 2, 4, false, false}},
    {GL_RGB16F, {GL_RGB, GL_HALF_FLOAT, 3, 6, false, false}},
    {GL_RGBA16F, {GL_RGBA, GL_HALF_FLOAT, 4, 8, false, false}},
    {GL_R32F, {GL_RED, GL_FLOAT, 1, 4, false, false}},
    {GL_RG32F, {GL_RG, GL_FLOAT, 2, 8, false, false}},
    {GL_RGB32F, {GL_RGB, GL_FLOAT, 3, 12, false, false}},
    {GL_RGBA32F, {GL_RGBA, GL_FLOAT, 4, 16, false, false}},
    {GL_R11F_G11F_B10F, {GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, 3, 4, false, false}},
    {GL_RGB9_E5, {GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV, 3, 4, false, false}},
    // integer
    {GL_R8UI, {GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1, 1, true, false}},
    {GL_RG8UI, {GL_RG_INTEGER, GL_UNSIGNED_BYTE, 2, 2, true, false}},
    {GL_RGBA8UI, {GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, 4, 4, true, false}},
    {GL_R16UI, {GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1, 2, true, false}},
    {GL_RG16UI, {GL_RG_INTEGER, GL_UNSIGNED_SHORT, 2, 4, true, false}},
    {GL_RGBA16UI, {GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 4, 8, true, false}},
    {GL_R32UI, {GL_RED_INTEGER, GL_UNSIGNED_INT, 1, 4, true, false}},
    {GL_RG32UI, {GL_RG_INTEGER, GL_UNSIGNED_INT, 2, 8, true, false}},
    {GL_RGBA32UI, {GL_RGBA_INTEGER, GL_UNSIGNED_INT, 4, 16, true, false}},
    {GL_R8I, {GL_RED_INTEGER, GL_BYTE, 1, 1, true, false}},
    {GL_R16I, {GL_RED_INTEGER, GL_SHORT, 1, 2, true, false}},
    {GL_RG16I, {GL_RG_INTEGER, GL_SHORT, 2, 4, true, false}},
    {GL_R32I, {GL_RED_INTEGER, GL_INT, 1, 4, true, false}},
    {GL_RG32I, {GL_RG_INTEGER, GL_INT, 2, 8, true, false}},
    {GL_RGBA32I, {GL_RGBA_INTEGER, GL_INT, 4, 16, true, false}},
    // depth
    {GL_DEPTH_COMPONENT16, {GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, 1, 2, false, true}},
    {GL_DEPTH_COMPONENT24, {GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 1, 4, false, true}},
    {GL_DEPTH_COMPONENT32F, {GL_DEPTH_COMPONENT, GL_FLOAT, 1, 4, false, true}},
    {GL_DEPTH24_STENCIL8, {GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, 1, 4, false, true}},
    {GL_DEPTH32F_STENCIL8, {GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 1, 8, false, true}},
};

} // namespace

PixelLayout nativeLayout(GLenum internalFormat) {
  for (const KnownFormat& known : kKnownFormats)
    if (known.internalFormat == internalFormat) return known.layout;
  throw Failure(fmt::format("texture format {:#x} is not known", internalFormat));
}

} // namespace brickfield
