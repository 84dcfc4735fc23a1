// Values of the command line from their texts.
#include "app/parse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ParseSize, ReadsBothSidesUpToTheLimit) {
  EXPECT_EQ(parseSize("--size", "1280x720"), glm::uvec2(1280, 720));
  EXPECT_EQ(parseSize("--size", "1x16384"), glm::uvec2(1, 16384));
}

TEST(ParseSize, RefusesEverythingElseAndNamesFlagAndText) {
  for (const char* text : {"", "12", "0x5", "5x0", "16385x1", "1x2x3", "-1x5", "1.5x2", "4 x4", "99999999999x1", "0x"})
    EXPECT_THAT(refusalOf([&] { parseSize("--size", text); }), AllOf(HasSubstr("--size: "), HasSubstr(text)));
}

TEST(ParseVector, ReadsThreeNumbers) {
  EXPECT_EQ(parseVector("--eye", "-1,2.5,-.25"), glm::vec3(-1.0f, 2.5f, -0.25f));
  EXPECT_EQ(parseVector("--eye", "1e2,0,-0"), glm::vec3(100.0f, 0.0f, 0.0f));
}

TEST(ParseVector, RefusesEverythingElse) {
  for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "a,b,c", "1,2,nan", "1,2,inf", "1e99,0,0", "1, 2,3", "1,2,3 "})
    EXPECT_THAT(refusalOf([&] { parseVector("--eye", text); }), HasSubstr("--eye: ")) << text;
}

TEST(ParseNumber, KeepsItsRange) {
  EXPECT_EQ(parseNumber("--t", "0.5", 0, 1), 0.5);
  EXPECT_EQ(parseNumber("--t", "1", 0, 1), 1.0);
  for (const char* text : {"1.01", "-0.01", "nan", "inf", "", "x", "0.5x", "0x1"})
    EXPECT_THAT(refusalOf([&] { parseNumber("--t", text, 0, 1); }), HasSubstr("--t: ")) << text;
}

TEST(ParseWhole, KeepsItsRange) {
  EXPECT_EQ(parseWhole("--n", "-3", -3, 7), -3);
  for (const char* text : {"8", "-4", "1.5", "", "two", "99999999999999999999"})
    EXPECT_THAT(refusalOf([&] { parseWhole("--n", text, -3, 7); }), HasSubstr("--n: ")) << text;
}

TEST(SplitText, HasOnePieceMoreThanSeparators) {
  EXPECT_THAT(splitText("a,,b", ','), ::testing::ElementsAre("a", "", "b"));
  EXPECT_THAT(splitText("", ','), ::testing::ElementsAre(""));
}

} // namespace
} // namespace brickfield
