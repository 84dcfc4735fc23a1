// Messages of bad input: one printable line that names who is at fault.
#include "core/error.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace brickfield::test {
namespace {

TEST(BadInputMessage, NamesSubjectElementAndReason) {
  EXPECT_STREQ(BadInput("scene.glb", "node 3 \"Arm\"", "too thin").what(), "scene.glb: node 3 \"Arm\": too thin");
  EXPECT_STREQ(BadInput("scene.glb", "", "too thin").what(), "scene.glb: too thin");
}

TEST(BadInputMessage, ControlCharactersDoNotBreakTheLine) {
  const std::string text = BadInput("a\nb", "\x1b[31m\t\x7f", std::string("x\0y", 3)).what();
  EXPECT_EQ(text.size(), std::string("a\nb: \x1b[31m\t\x7f: x\0y").size() + 2); // the zero does not end it
  EXPECT_TRUE(
      std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }));
}

TEST(BadInputMessage, EndlessTextIsCut) {
  const std::string text = BadInput("file", "", std::string(1u << 20, 'x')).what();
  EXPECT_LT(text.size(), 1100u);
  EXPECT_EQ(text.substr(text.size() - 3), "...");
}

TEST(BadInputMessage, OtherLettersStay) {
  EXPECT_STREQ(BadInput("Ängström.glb", "", "größer").what(), "Ängström.glb: größer");
}

TEST(Errors, ShareOneBase) {
  EXPECT_THROW(throw BadInput("a", "", "b"), Error);
  EXPECT_THROW(throw Failure("a"), Error);
  EXPECT_THROW(throw Cancelled(), Error);
}

} // namespace
} // namespace brickfield::test
