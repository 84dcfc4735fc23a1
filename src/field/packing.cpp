// Packings of surface attributes: RGBA8 as GLSL's packUnorm4x8, RGB9E5 as EXT_texture_shared_exponent defines it.
#include <algorithm>
#include <cmath>

#include "field/brick_field.h"

namespace brickfield {

namespace {
constexpr int kMantissaBits = 9;
constexpr int kExponentBias = 15;
constexpr int kLargestExponent = 31;
// sharedexp_max of the extension: (2^9 - 1) / 2^9 * 2^(31 - 15)
constexpr float kLargestRgb9e5 = 65408.0f;

// NaN becomes 0, as the extension allows and GLSL's clamp leaves open.
float clampOrZero(float value, float most) { return value > 0.0f ? std::min(value, most) : 0.0f; }
} // namespace

std::uint32_t packRgba8(glm::vec4 unit) {
  std::uint32_t packed = 0;
  for (int i = 0; i < 4; ++i)
    packed |= static_cast<std::uint32_t>(std::floor(clampOrZero(unit[i], 1.0f) * 255.0f + 0.5f)) << (8 * i);
  return packed;
}

glm::vec4 unpackRgba8(std::uint32_t packed) {
  glm::vec4 unit;
  for (int i = 0; i < 4; ++i) unit[i] = static_cast<float>((packed >> (8 * i)) & 0xffu) / 255.0f;
  return unit;
}

std::uint32_t packRgb9e5(glm::vec3 radiance) {
  glm::vec3 clamped;
  for (int i = 0; i < 3; ++i) clamped[i] = clampOrZero(radiance[i], kLargestRgb9e5);
  const float largest = std::max({clamped.x, clamped.y, clamped.z});
  // ilogb is the exact floor(log2); of 0 it is a huge negative number, which the maximum takes care of.
  int exponent = std::max(-kExponentBias - 1, std::ilogb(largest)) + 1 + kExponentBias;
  const auto mantissaOf = [&](float value) {
    return static_cast<std::uint32_t>(std::floor(std::ldexp(value, kExponentBias + kMantissaBits - exponent) + 0.5f));
  };
  if (mantissaOf(largest) == 1u << kMantissaBits) ++exponent;
  exponent = std::min(exponent, kLargestExponent);
  return mantissaOf(clamped.x) | mantissaOf(clamped.y) << 9 | mantissaOf(clamped.z) << 18 |
         static_cast<std::uint32_t>(exponent) << 27;
}

glm::vec3 unpackRgb9e5(std::uint32_t packed) {
  const int exponent = static_cast<int>(packed >> 27) - kExponentBias - kMantissaBits;
  const auto channel = [&](int shift) { return std::ldexp(static_cast<float>((packed >> shift) & 0x1ffu), exponent); };
  return {channel(0), channel(9), channel(18)};
}

} // namespace brickfield
