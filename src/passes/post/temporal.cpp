// Formats as declared in the header.
#include "passes/post/temporal.h"

namespace brickfield {

namespace {

float radicalInverse(std::uint32_t number, std::uint32_t base) {
  float result = 0, digit = 1.0f / static_cast<float>(base);
  for (; number > 0; number /= base, digit /= static_cast<float>(base))
    result += digit * static_cast<float>(number % base);
  return result;
}

Texture layer(const char* label, GLenum format, glm::uvec2 size) {
  return Texture::make2D(label, format, static_cast<int>(size.x), static_cast<int>(size.y));
}

} // namespace

glm::vec2 taaJitter(std::uint32_t frame) {
  constexpr std::uint32_t kPoints = 64;
  const std::uint32_t number = frame % kPoints + 1; // number 0 is a corner
  return {radicalInverse(number, 2) - 0.5f, radicalInverse(number, 3) - 0.5f};
}

Temporal::Temporal(const FrameTargets& targets)
    : motion(layer("motion", GL_RGBA16F, targets.size)),
      gbuffer("gbuffer_and_motion", {{GL_COLOR_ATTACHMENT0, &targets.normalWorldOct},
                                     {GL_COLOR_ATTACHMENT1, &targets.albedo},
                                     {GL_COLOR_ATTACHMENT2, &targets.material},
                                     {GL_COLOR_ATTACHMENT3, &targets.emission},
                                     {GL_COLOR_ATTACHMENT4, &targets.id},
                                     {GL_COLOR_ATTACHMENT5, &targets.trace},
                                     {GL_COLOR_ATTACHMENT6, &motion},
                                     {GL_DEPTH_ATTACHMENT, &targets.depth}}),
      history{layer("taa_history_0", GL_RGBA16F, targets.size), layer("taa_history_1", GL_RGBA16F, targets.size)},
      historyDepth{layer("taa_depth_0", GL_R32F, targets.size), layer("taa_depth_1", GL_R32F, targets.size)} {}

std::size_t Temporal::bytes() const {
  return motion.bytes() + 2 * history[0].bytes() + 2 * historyDepth[0].bytes() + table.bytes();
}

} // namespace brickfield
