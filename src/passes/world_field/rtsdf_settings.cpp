// Ranges and derived values.
#include "passes/world_field/rtsdf_settings.h"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr int kLeastSize = 8, kMostSize = 512, kMostRays = 64;

[[noreturn]] void refuse(std::string_view parameter, const std::string& reason) {
  throw BadInput("rtsdf", parameter, reason);
}

void checkSize(std::string_view parameter, int size) {
  if (size < kLeastSize || size > kMostSize || !std::has_single_bit(static_cast<unsigned>(size)))
    refuse(parameter, fmt::format("{} is no power of two from {} to {}", size, kLeastSize, kMostSize));
}

void checkLength(std::string_view parameter, float length) {
  if (!(length >= 0) || !std::isfinite(length)) refuse(parameter, fmt::format("{} is not in [0, inf)", length));
}

} // namespace

void setRtsdfSize(RtsdfSettings& settings, std::string_view name) {
  if (name == "S")
    settings.coarseSize = 64;
  else if (name == "M")
    settings.coarseSize = 128;
  else if (name == "L")
    settings.coarseSize = 256;
  else
    refuse("size", fmt::format("\"{}\" is none of S, M, L", name));
  settings.fineSize = 2 * settings.coarseSize;
}

float rtsdfBeta(const RtsdfSettings& settings) {
  return settings.beta.value_or(0.1f * 2.0f / static_cast<float>(settings.coarseSize));
}

glm::ivec3 rtsdfExtent(const RtsdfSettings& settings) {
  return settings.bruteForce ? settings.bruteExtent : glm::ivec3(settings.fineSize);
}

void checkRtsdfSettings(const RtsdfSettings& settings) {
  checkSize("coarse size", settings.coarseSize);
  checkSize("fine size", settings.fineSize);
  if (settings.raysPerTexel < 0 || settings.raysPerTexel > kMostRays)
    refuse("rays", fmt::format("{} is not in [0, {}]", settings.raysPerTexel, kMostRays));
  if (!(settings.decay >= 0 && settings.decay <= 1))
    refuse("decay", fmt::format("{} is not in [0, 1]", settings.decay));
  if (!(settings.maskWidth >= 0)) refuse("mask width", fmt::format("{} is not in [0, inf]", settings.maskWidth));
  checkLength("bias", settings.bias);
  if (settings.beta) checkLength("beta", *settings.beta);
  for (int axis = 0; axis < 3; ++axis)
    if (settings.bruteExtent[axis] < kLeastSize || settings.bruteExtent[axis] > kMostSize)
      refuse("brute force size",
             fmt::format("{} is not in [{}, {}]", settings.bruteExtent[axis], kLeastSize, kMostSize));
}

} // namespace brickfield
