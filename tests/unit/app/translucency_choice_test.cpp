// What the flags of translucency take, and what they mean for each other.
#include "app/translucency_choice.h"

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
TranslucencyChoice parse(std::vector<std::string> arguments, const std::string& view = "") {
  CLI::App app;
  TranslucencyChoice choice;
  addTranslucencyOptions(app, choice);
  app.parse(std::move(arguments));
  settleTranslucencyChoice(choice, view);
  return choice;
}

TEST(TranslucencyChoice, WordsAndNumbers) {
  EXPECT_EQ(parse({}).settings, TranslucencySettings{});
  EXPECT_EQ(parse({"off", "--translucency"}).settings, TranslucencySettings{});
  EXPECT_EQ(parse({"on", "--translucency"}, "thickness").settings.source, TranslucencySource::Materials);
  const TranslucencySettings given = parse({"0.25", "--translucency-wrap", "0.5:1,2,3.5", "--translucency"}).settings;
  EXPECT_EQ(given, (TranslucencySettings{TranslucencySource::Given, 0.5f, {1, 2, 3.5f}, 0.25f}));
  for (const char* text : {"off", "on", "0.5:1,2,3.5"})
    EXPECT_EQ(translucencyText(parseTranslucency("--translucency", text)), text);
}

TEST(TranslucencyChoice, WhatIsWrongIsNamed) {
  for (const char* text : {"yes", "0.5", "0.5:1,2", "1.5:0,0,0", "0.5:1,2,-3", ":", "0.5:1,2,3:4"})
    EXPECT_THAT(refusalOf([&] { parse({text, "--translucency"}); }), HasSubstr("--translucency: ")) << text;
  EXPECT_THAT(refusalOf([] {
                parse({"0.5", "--translucency-wrap"});
              }),
              HasSubstr("--translucency-wrap: needs --translucency"));
  EXPECT_THAT(refusalOf([] {
                parse({"2", "--translucency-wrap", "on", "--translucency"});
              }),
              HasSubstr("--translucency-wrap: "));
  EXPECT_THAT(refusalOf([] { parse({}, "thickness"); }), AllOf(HasSubstr("--view: "), HasSubstr("--translucency")));
}

} // namespace
} // namespace brickfield
