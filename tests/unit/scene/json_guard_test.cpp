// Depth and size of JSON before any parser sees it.
#include "scene/json_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {

namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string errorOf(std::string_view text, int depthLimit = 200) {
  try {
    parseGuardedJson(text, "file.gltf", depthLimit);
  } catch (const BadInput& error) {
    return error.what();
  }
  return {};
}

TEST(JsonGuard, DepthCountsBothBrackets) {
  EXPECT_EQ(measureJson("").depth, 0u);
  EXPECT_EQ(measureJson("{}").depth, 1u);
  EXPECT_EQ(measureJson(R"({"a":[[1],[{}]]})").depth, 4u);
}

TEST(JsonGuard, BracketsInStringsDoNotCount) {
  EXPECT_EQ(measureJson(R"({"a":"[[[[{{{{"})").depth, 1u);
  EXPECT_EQ(measureJson(R"({"a\"[[":"\\", "b":[]})").depth, 2u) << "the string that ends in a backslash is closed";
}

TEST(JsonGuard, UnbalancedTextIsMeasuredToo) {
  EXPECT_EQ(measureJson("]]]]{").depth, 1u);
  EXPECT_EQ(measureJson("\"[[[").depth, 0u);
  EXPECT_EQ(measureJson("\"\\").depth, 0u);
}

TEST(JsonGuard, ValuesAreAnUpperBound) {
  EXPECT_GE(measureJson(R"({"a":[1,2,3],"b":{}})").values, 6u);
  EXPECT_GE(measureJson("[[],[],[]]").values, 4u);
}

TEST(JsonGuard, DepthAtTheLimitIsReadAboveIsNot) {
  const auto nested = [](int depth) {
    return "{\"a\":" + std::string(static_cast<std::size_t>(depth - 1), '[') +
           std::string(static_cast<std::size_t>(depth - 1), ']') + "}";
  };
  EXPECT_EQ(errorOf(nested(20), 20), "");
  EXPECT_THAT(errorOf(nested(21), 20), HasSubstr("nested 21 deep, at most 20"));
  EXPECT_THAT(errorOf(nested(200000)), HasSubstr("nested 200000 deep"));
}

TEST(JsonGuard, TooManyValuesAreRefusedUnparsed) {
  const std::string text = "{\"a\":[" + std::string(70'000'000, ',');
  EXPECT_THAT(errorOf(text), HasSubstr("values, at most"));
}

TEST(JsonGuard, ErrorsNameTheFile) {
  EXPECT_THAT(errorOf("{"), HasSubstr("file.gltf: JSON: "));
  EXPECT_THAT(errorOf("[]"), HasSubstr("is a JSON array, not an object"));
  EXPECT_THAT(errorOf("\xEF\xBB\xBF{}"), HasSubstr("byte order mark"));
  EXPECT_THAT(errorOf("{\"a\":\"\xFF\"}"), HasSubstr("JSON")) << "broken UTF-8";
  EXPECT_THAT(errorOf("{\"a\":1e999}"), HasSubstr("JSON")) << "a number that no double holds";
  EXPECT_EQ(errorOf("{\"a\": 1}"), "");
}

TEST(JsonGuard, ErrorsNameThePlaceAndWhatIsMissingAndNoLibrary) {
  EXPECT_EQ(errorOf("{\n  \"a\": 1,\n  \"b\" 2\n}"),
            "file.gltf: JSON: line 3, column 7: unexpected number literal; expected ':'");
  EXPECT_EQ(errorOf("{]"), "file.gltf: JSON: line 1, column 2: unexpected ']'; expected string literal");
  EXPECT_THAT(errorOf(""), HasSubstr("line 1, column 1: unexpected end of input"));
  EXPECT_THAT(errorOf("{\"1e999\":\n [1,1e999]}"), HasSubstr("line 2, column "));
  for (const char* text :
       {"", "{", "{a", "{\"a\":nul}", "{\"a\":1e999}", "{\"a\":\"\xFF\"}", "{\"a\":\"\\u12\"}", "{} x"}) {
    EXPECT_THAT(errorOf(text), HasSubstr("JSON: line 1, column ")) << text;
    EXPECT_THAT(errorOf(text), Not(HasSubstr("json.exception"))) << text;
    EXPECT_THAT(errorOf(text), Not(HasSubstr("while parsing"))) << text;
  }
}

} // namespace

} // namespace brickfield
