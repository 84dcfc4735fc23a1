// Buffers keep what was put in, refuse what leaves them, and grow without loss.
#include "gpu/buffer.h"

#include <numeric>

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

using ::testing::ElementsAre;

class BufferTest : public GlTest {};

TEST_F(BufferTest, ContentComesBack) {
  const Buffer buffer("floats", std::vector<float>{1.5f, -2.0f, 3.25f});
  EXPECT_EQ(buffer.bytes(), 12u);
  EXPECT_THAT(buffer.read<float>(), ElementsAre(1.5f, -2.0f, 3.25f));
  EXPECT_THAT(buffer.read<float>(4, 1), ElementsAre(-2.0f));
}

TEST_F(BufferTest, PartsAreOverwritten) {
  Buffer buffer("words", std::vector<std::uint32_t>{1, 2, 3, 4});
  buffer.upload(4, std::vector<std::uint32_t>{20, 30});
  buffer.uploadValue(std::uint32_t{40}, 12);
  EXPECT_THAT(buffer.read<std::uint32_t>(), ElementsAre(1, 20, 30, 40));
}

TEST_F(BufferTest, StaticStorageIsFilledButNotUploaded) {
  Buffer buffer("static", std::vector<int>{5, 6}, 0);
  EXPECT_THAT(buffer.read<int>(), ElementsAre(5, 6));
  EXPECT_THROW(buffer.upload(0, std::vector<int>{1}), Failure);
}

TEST_F(BufferTest, LeavingItIsAFailureThatNamesIt) {
  Buffer buffer("short", std::vector<int>{1, 2});
  EXPECT_THROW(buffer.upload(4, std::vector<int>{1, 2}), Failure);
  EXPECT_THROW(buffer.upload(static_cast<std::size_t>(-4), std::vector<int>{1, 2}), Failure);
  EXPECT_THROW(buffer.read<int>(4, 2), Failure);
  EXPECT_THROW(buffer.clear(0, 4, 8), Failure);
  EXPECT_THROW(buffer.bindStorage(0, 0, 12), Failure);
  try {
    buffer.read<int>(12, 1);
    FAIL();
  } catch (const Failure& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("\"short\""));
  }
}

TEST_F(BufferTest, EmptyOneCanBeBound) {
  Buffer buffer("empty", std::vector<int>{});
  EXPECT_EQ(buffer.bytes(), 0u);
  EXPECT_TRUE(buffer.read<int>().empty());
  buffer.bindStorage(0);
  buffer.upload(0, std::vector<int>{});
  buffer.clear(1);
}

TEST_F(BufferTest, ClearFillsWordsAndParts) {
  Buffer buffer("cleared", std::vector<std::uint32_t>(4, 9));
  buffer.clear(0xffffffffu);
  buffer.clear(3, 4, 8);
  EXPECT_THAT(buffer.read<std::uint32_t>(), ElementsAre(0xffffffffu, 3, 3, 0xffffffffu));
  Buffer odd("odd", std::vector<std::uint8_t>{1, 2, 3});
  odd.clear(0);
  EXPECT_THAT(odd.read<std::uint8_t>(), ElementsAre(0, 0, 0));
  EXPECT_THROW(odd.clear(0x01020304u), Failure);
}

// What is uploaded right after a growth lands over the copy of the old bytes, not under it.
TEST_F(BufferTest, UploadAfterGrowthWins) {
  Buffer buffer("growing", std::size_t{1} << 16);
  for (std::uint32_t round = 1; round <= 6; ++round) {
    buffer.clear(0u);
    const std::size_t oldBytes = buffer.bytes();
    ASSERT_TRUE(buffer.growTo(oldBytes + 4));
    const std::vector<std::uint32_t> upload(64, round);
    buffer.upload(oldBytes - 256, upload);
    EXPECT_EQ(buffer.read<std::uint32_t>(oldBytes - 256, 64), upload) << "round " << round;
  }
}

TEST_F(BufferTest, GrowthKeepsContent) {
  std::vector<int> values(100);
  std::iota(values.begin(), values.end(), 0);
  Buffer buffer("growing", values);
  const GLuint before = buffer.id();
  EXPECT_FALSE(buffer.growTo(400));
  EXPECT_EQ(buffer.id(), before);
  EXPECT_TRUE(buffer.growTo(404));
  EXPECT_GE(buffer.bytes(), 600u) << "growth by single steps would copy for ever";
  EXPECT_EQ(buffer.read<int>(0, 100), values);
  EXPECT_EQ(buffer.label(), "growing");
  buffer.upload(400, std::vector<int>{-1});
  EXPECT_FALSE(glIsBuffer(before)) << "the old one was not freed";
}

TEST_F(BufferTest, MoveLeavesNothingBehind) {
  Buffer first("moved", std::vector<int>{4});
  const GLuint id = first.id();
  Buffer second = std::move(first);
  EXPECT_EQ(first.id(), 0u);
  EXPECT_EQ(second.id(), id);
  second = Buffer("next", std::vector<int>{5});
  EXPECT_FALSE(glIsBuffer(id));
  EXPECT_THAT(second.read<int>(), ElementsAre(5));
}

TEST_F(BufferTest, LabelReachesTheDriver) {
  const Buffer buffer("brick_indirection", 4);
  char text[64] = {};
  glGetObjectLabel(GL_BUFFER, buffer.id(), sizeof text, nullptr, text);
  EXPECT_STREQ(text, "brick_indirection");
}

TEST_F(BufferTest, ImpossibleSizeIsAFailure) {
  EXPECT_THROW(Buffer("huge", std::size_t{1} << 60), Failure);
  context().takeGlErrors(); // The debug output has told of it too.
}

} // namespace
} // namespace brickfield::test
