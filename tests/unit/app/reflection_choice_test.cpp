// What the flags of reflections take, and what they mean for each other.
#include "app/reflection_choice.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

// Arguments in reverse, as CLI11 takes them.
ReflectionSettings parse(std::vector<std::string> arguments, const std::string& view = "", bool hasExactField = true) {
  CLI::App app;
  ReflectionChoice choice;
  addReflectionOptions(app, choice);
  app.parse(std::move(arguments));
  checkReflectionChoice(choice, view, hasExactField);
  return choice.settings;
}

TEST(ReflectionChoice, MethodsAndScales) {
  EXPECT_EQ(parse({}), ReflectionSettings{});
  EXPECT_EQ(parse({"off", "--reflections"}, "", false), ReflectionSettings{});
  EXPECT_EQ(parse({"field", "--reflections"}, "reflection"), (ReflectionSettings{ReflectionMethod::Field, 2}));
  EXPECT_EQ(parse({"full", "--reflection-scale", "field", "--reflections"}).scale, 1);
}

TEST(ReflectionChoice, WhatDoesNotGoTogetherIsNamed) {
  EXPECT_THAT(refusalOf([] {
                parse({"ssr", "--reflections"});
              }),
              AllOf(HasSubstr("--reflections: "), HasSubstr("ssr"), HasSubstr("field")));
  EXPECT_THAT(refusalOf([] {
                parse({"third", "--reflection-scale", "field", "--reflections"});
              }),
              HasSubstr("--reflection-scale: "));
  EXPECT_THAT(refusalOf([] { parse({"half", "--reflection-scale"}); }), HasSubstr("needs --reflections"));
  EXPECT_THAT(refusalOf([] { parse({}, "reflection"); }), AllOf(HasSubstr("--view: "), HasSubstr("--reflections")));
  EXPECT_THAT(refusalOf([] { parse({"field", "--reflections"}, "", false); }), HasSubstr("--world-field exact"));
}

} // namespace
} // namespace brickfield
