// Framebuffers clear and draw where they should, and say what is wrong when incomplete.
#include "gpu/framebuffer.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class FramebufferTest : public GlTest {};

std::string failureOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Failure& error) {
    return error.what();
  }
  return "no failure";
}

TEST_F(FramebufferTest, EachOutputClearsItsAttachment) {
  Texture color = Texture::make2D("color", GL_RGBA8, 4, 3);
  Texture ids = Texture::make2D("ids", GL_R32UI, 4, 3);
  Texture depth = Texture::make2D("depth", GL_DEPTH_COMPONENT32F, 4, 3);
  Framebuffer framebuffer(
      "gbuffer", {{GL_COLOR_ATTACHMENT0, &color}, {GL_COLOR_ATTACHMENT1, &ids}, {GL_DEPTH_ATTACHMENT, &depth}});
  framebuffer.clearColor(0, glm::vec4(1, 0, 0, 1));
  framebuffer.clearColor(1, glm::uvec4(42));
  framebuffer.clearDepth(0.5f);
  EXPECT_EQ(color.read<std::uint32_t>()[11], 0xff0000ffu);
  EXPECT_EQ(ids.read<std::uint32_t>(), std::vector<std::uint32_t>(12, 42));
  EXPECT_EQ(depth.read<float>()[5], 0.5f);
}

TEST_F(FramebufferTest, BindSetsTheViewport) {
  Texture color = Texture::make2D("color", GL_RGBA8, 16, 8, 3);
  Framebuffer framebuffer("level", {{GL_COLOR_ATTACHMENT0, &color, 1}});
  EXPECT_EQ(framebuffer.extent(), glm::ivec2(8, 4));
  framebuffer.bind();
  glm::ivec4 viewport{0};
  glGetIntegerv(GL_VIEWPORT, &viewport.x);
  EXPECT_EQ(viewport, glm::ivec4(0, 0, 8, 4));
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

TEST_F(FramebufferTest, OneLayerIsAttachedAlone) {
  Texture layers = Texture::make2DArray("layers", GL_R8, 2, 2, 3);
  layers.clear(glm::vec4(0));
  Framebuffer framebuffer("layer", {{GL_COLOR_ATTACHMENT0, &layers, 0, 1}});
  framebuffer.clearColor(0, glm::vec4(1));
  EXPECT_EQ(layers.read<std::uint8_t>(), (std::vector<std::uint8_t>{0, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0}));
}

TEST_F(FramebufferTest, IncompleteOneNamesLabelAndReason) {
  Texture flat = Texture::make2D("flat", GL_RGBA8, 4, 4);
  Texture layers = Texture::make2DArray("layers", GL_RGBA8, 4, 4, 2);
  EXPECT_THAT(failureOf([&] {
                Framebuffer("target_hdr", {{GL_COLOR_ATTACHMENT0, &flat}, {GL_COLOR_ATTACHMENT1, &layers}});
              }),
              ::testing::HasSubstr("\"target_hdr\": attachments differ in being layered"));
  EXPECT_THAT(failureOf([&] { Framebuffer("nothing", std::span<const Attachment>()); }),
              ::testing::HasSubstr("\"nothing\": no attachment"));
  EXPECT_THAT(failureOf([&] {
                Framebuffer("null", {{GL_COLOR_ATTACHMENT0, nullptr}});
              }),
              ::testing::HasSubstr("\"null\""));
}

TEST_F(FramebufferTest, WithoutAttachmentsItHasASize) {
  const Framebuffer framebuffer("voxelize", glm::ivec2(128, 64));
  framebuffer.bind();
  glm::ivec4 viewport{0};
  glGetIntegerv(GL_VIEWPORT, &viewport.x);
  EXPECT_EQ(viewport, glm::ivec4(0, 0, 128, 64));
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

} // namespace
} // namespace brickfield::test
