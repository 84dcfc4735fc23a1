// Texels go up and come back as they are, in every shape, whatever the pixel store state of a host.
#include "gpu/texture.h"

#include <numeric>

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class TextureTest : public GlTest {};

template <typename Element>
std::vector<Element> counted(std::size_t count, int first = 1) {
  std::vector<Element> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<Element>(first + static_cast<int>(i) * 3);
  return values;
}

TEST_F(TextureTest, SnormVolumeOfOddSizeComesBack) {
  Texture texture = Texture::make3D("bricks", GL_R8_SNORM, {5, 3, 7});
  const auto values = counted<std::int8_t>(5 * 3 * 7, -100);
  texture.upload(values);
  EXPECT_EQ(texture.read<std::int8_t>(), values);
  EXPECT_FLOAT_EQ(texture.readFloats()[0], -100.0f / 127.0f);
}

TEST_F(TextureTest, UnsignedIntegersComeBack) {
  Texture texture = Texture::make2D("ids", GL_R32UI, 3, 2);
  const std::vector<std::uint32_t> values = {0, 1, 0xffffffffu, 0x80000000u, 77, 0x12345678u};
  texture.upload(values);
  EXPECT_EQ(texture.read<std::uint32_t>(), values);
  EXPECT_THROW(texture.readFloats(), Failure);
}

TEST_F(TextureTest, RowsOfThreeBytesAreTight) {
  Texture texture = Texture::make2D("rgb", GL_RGB8, 5, 3);
  const auto values = counted<std::uint8_t>(5 * 3 * 3);
  texture.upload(values);
  EXPECT_EQ(texture.read<std::uint8_t>(), values);
}

TEST_F(TextureTest, EveryKnownFormatIsAccepted) {
  for (const GLenum format : {GL_R8,           GL_RG8,       GL_RGBA8,
                              GL_SRGB8_ALPHA8, GL_RG8_SNORM, GL_RGBA8_SNORM,
                              GL_R16,          GL_RG16,      GL_R16_SNORM,
                              GL_RG16_SNORM,   GL_RGB10_A2,  GL_R16F,
                              GL_RG16F,        GL_RGBA16F,   GL_R32F,
                              GL_RG32F,        GL_RGBA32F,   GL_R11F_G11F_B10F,
                              GL_RGB9_E5,      GL_R8UI,      GL_R16UI,
                              GL_RG16UI,       GL_RG32UI,    GL_RGBA32UI,
                              GL_R32I,         GL_RGBA32I,   GL_DEPTH_COMPONENT32F}) {
    Texture texture = Texture::make2D("format", format, 4, 4);
    const std::vector<std::byte> zeros(static_cast<std::size_t>(16 * nativeLayout(format).bytesPerPixel));
    texture.upload(zeros);
    EXPECT_EQ(texture.read<std::byte>(), zeros) << std::hex << format;
    EXPECT_TRUE(context().takeGlErrors().empty()) << std::hex << format;
  }
}

TEST_F(TextureTest, BoxesChangeNothingElse) {
  Texture texture = Texture::make3D("box", GL_R8, {4, 4, 4});
  texture.clear(glm::vec4(1));
  texture.upload(0, {1, 2, 3}, {2, 2, 1}, std::vector<std::uint8_t>{10, 20, 30, 40});
  EXPECT_EQ(texture.read<std::uint8_t>(0, {1, 2, 3}, {2, 2, 1}), (std::vector<std::uint8_t>{10, 20, 30, 40}));
  const auto all = texture.read<std::uint8_t>();
  EXPECT_EQ(std::count(all.begin(), all.end(), 255), 60);
  EXPECT_EQ(all[1 + 4 * 2 + 16 * 3], 10);
}

TEST_F(TextureTest, LayersAndFacesAreKeptApart) {
  Texture layers = Texture::make2DArray("layers", GL_R16UI, 3, 2, 4);
  const auto values = counted<std::uint16_t>(3 * 2 * 4);
  layers.upload(values);
  EXPECT_EQ(layers.read<std::uint16_t>(), values);
  Texture cube = Texture::makeCube("cube", GL_R8, 3);
  const auto faces = counted<std::uint8_t>(3 * 3 * 6);
  cube.upload(faces);
  EXPECT_EQ(cube.read<std::uint8_t>(), faces);
  EXPECT_EQ(cube.read<std::uint8_t>(0, {0, 0, 5}, {3, 3, 1}), std::vector<std::uint8_t>(faces.end() - 9, faces.end()));
}

TEST_F(TextureTest, StateOfTheHostNeitherMattersNorChanges) {
  Texture texture = Texture::make2D("host", GL_R8, 5, 3);
  Texture pixelBufferUser = Texture::make2D("other", GL_R8, 1, 1);
  GLuint unpack = 0;
  glCreateBuffers(1, &unpack);
  glNamedBufferStorage(unpack, 64, nullptr, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, unpack);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 11);
  glPixelStorei(GL_UNPACK_SKIP_ROWS, 1);
  glPixelStorei(GL_PACK_ALIGNMENT, 8);
  glPixelStorei(GL_PACK_SKIP_PIXELS, 2);
  const auto values = counted<std::uint8_t>(15);
  texture.upload(values);
  EXPECT_EQ(texture.read<std::uint8_t>(), values);
  const auto state = [](GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
  };
  EXPECT_EQ(state(GL_UNPACK_ROW_LENGTH), 11);
  EXPECT_EQ(state(GL_UNPACK_SKIP_ROWS), 1);
  EXPECT_EQ(state(GL_PACK_ALIGNMENT), 8);
  EXPECT_EQ(state(GL_PACK_SKIP_PIXELS), 2);
  EXPECT_EQ(state(GL_PIXEL_UNPACK_BUFFER_BINDING), static_cast<GLint>(unpack));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glDeleteBuffers(1, &unpack);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_SKIP_ROWS, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_SKIP_PIXELS, 0);
}

TEST_F(TextureTest, WrongSizesAreFailuresThatNameIt) {
  Texture texture = Texture::make2D("picky", GL_R8, 4, 4, 2);
  EXPECT_THROW(texture.upload(std::vector<std::uint8_t>(15)), Failure);
  EXPECT_THROW(texture.upload(0, {1, 0, 0}, {4, 1, 1}, std::vector<std::uint8_t>(4)), Failure);
  EXPECT_THROW(texture.upload(0, {-1, 0, 0}, {1, 1, 1}, std::vector<std::uint8_t>(1)), Failure);
  EXPECT_THROW(texture.read<std::uint8_t>(2), Failure);
  EXPECT_THROW(texture.read<glm::vec3>(), Failure);
  try {
    texture.read<std::uint8_t>(0, {0, 0, 0}, {5, 1, 1});
    FAIL();
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("\"picky\""));
  }
}

TEST_F(TextureTest, ImpossibleShapesAreFailures) {
  EXPECT_THROW(Texture::make2D("wide", GL_R8, 1 << 24, 1), Failure);
  EXPECT_THROW(Texture::make2D("none", GL_R8, 0, 4), Failure);
  EXPECT_THROW(Texture::make2D("levels", GL_R8, 4, 4, 4), Failure);
  EXPECT_THROW(Texture("cube", {GL_TEXTURE_CUBE_MAP, GL_R8, {4, 2, 6}, 1}), Failure);
  EXPECT_THROW(Texture::make2D("format", GL_RGBA, 4, 4), Failure);
}

TEST_F(TextureTest, MipmapsAverage) {
  Texture texture = Texture::make2D("mips", GL_R32F, 4, 4, 0);
  EXPECT_EQ(texture.levels(), 3);
  std::vector<float> values(16);
  std::iota(values.begin(), values.end(), 0.0f);
  texture.upload(values);
  texture.generateMipmaps();
  EXPECT_EQ(texture.extent(1), glm::ivec3(2, 2, 1));
  EXPECT_NEAR(texture.readFloats(2).at(0), 7.5f, 1e-5f);
  EXPECT_EQ(texture.bytes(), (16u + 4u + 1u) * 4u);
}

TEST_F(TextureTest, ClearsOfEveryKind) {
  Texture ids = Texture::make2D("ids", GL_RG32UI, 2, 1);
  ids.clear(glm::uvec4(7, 0xffffffffu, 0, 0));
  EXPECT_EQ(ids.read<std::uint32_t>(), (std::vector<std::uint32_t>{7, 0xffffffffu, 7, 0xffffffffu}));
  Texture depth = Texture::make2D("depth", GL_DEPTH_COMPONENT32F, 2, 1);
  depth.clear(glm::vec4(0.25f));
  EXPECT_EQ(depth.read<float>(), (std::vector<float>{0.25f, 0.25f}));
  Texture color = Texture::make2D("color", GL_RGBA16F, 1, 1);
  color.clear(glm::vec4(1, -2, 0.5f, 4));
  EXPECT_EQ(color.readFloats(), (std::vector<float>{1, -2, 0.5f, 4}));
}

TEST_F(TextureTest, MoveLeavesNothingBehind) {
  Texture first = Texture::make2D("moved", GL_R8, 1, 1);
  const GLuint id = first.id();
  Texture second = std::move(first);
  EXPECT_EQ(first.id(), 0u);
  second = Texture::make2D("next", GL_R8, 1, 1);
  EXPECT_FALSE(glIsTexture(id));
}

TEST_F(TextureTest, SamplersCarryTheirOptions) {
  Sampler sampler("shadow",
                  {.minFilter = GL_NEAREST, .compare = GL_GREATER, .anisotropy = 1e9f, .border = {1, 2, 3, 4}});
  GLint value = 0;
  glGetSamplerParameteriv(sampler.id(), GL_TEXTURE_MIN_FILTER, &value);
  EXPECT_EQ(value, GL_NEAREST);
  glGetSamplerParameteriv(sampler.id(), GL_TEXTURE_COMPARE_FUNC, &value);
  EXPECT_EQ(value, GL_GREATER);
  glm::vec4 border(0);
  glGetSamplerParameterfv(sampler.id(), GL_TEXTURE_BORDER_COLOR, &border.x);
  EXPECT_EQ(border, glm::vec4(1, 2, 3, 4));
  sampler.bind(3);
  Sampler::unbind(3);
}

} // namespace
} // namespace brickfield::test
