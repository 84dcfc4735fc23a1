// What the flags of ambient occlusion take, and what they mean for each other.
#include "app/occlusion_choice.h"

#include <cmath>

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
OcclusionChoice parse(std::vector<std::string> arguments, const std::string& view = "", bool hasWorldField = true) {
  CLI::App app;
  OcclusionChoice choice;
  addOcclusionOptions(app, choice);
  app.parse(std::move(arguments));
  settleOcclusionChoice(choice, view, hasWorldField);
  return choice;
}

TEST(OcclusionChoice, FormsScalesAndRadii) {
  EXPECT_EQ(parse({}).settings, OcclusionSettings{});
  const OcclusionSettings cones = parse({"cones", "--ao"}).settings;
  EXPECT_EQ(cones.form, OcclusionForm::Cones);
  EXPECT_EQ(cones.scale, 2);
  EXPECT_TRUE(std::isinf(cones.radiusMetres)) << "as reference --ao without a radius";
  EXPECT_EQ(parse({"quarter", "--ao-scale", "cones", "--ao"}).settings.scale, 4);
  const OcclusionSettings taps = parse({"0.5", "--ao-radius", "full", "--ao-scale", "5tap", "--ao"}).settings;
  EXPECT_EQ(taps.form, OcclusionForm::Taps);
  EXPECT_EQ(taps.scale, 1);
  EXPECT_EQ(taps.radiusMetres, 0.5f);
  EXPECT_EQ(parse({"2", "--ao-radius", "rays", "--ao"}).settings.form, OcclusionForm::Rays);
  EXPECT_EQ(parse({"off", "--ao"}).settings.form, OcclusionForm::Off);
}

TEST(OcclusionChoice, WhatDoesNotGoTogetherIsNamed) {
  EXPECT_THAT(refusalOf([] {
                parse({"ssao", "--ao"});
              }),
              AllOf(HasSubstr("--ao: "), HasSubstr("ssao"), HasSubstr("cones")));
  EXPECT_THAT(refusalOf([] {
                parse({"third", "--ao-scale", "cones", "--ao"});
              }),
              AllOf(HasSubstr("--ao-scale: "), HasSubstr("third"), HasSubstr("quarter")));
  EXPECT_THAT(refusalOf([] {
                parse({"0", "--ao-radius", "cones", "--ao"});
              }),
              HasSubstr("--ao-radius: 0: is not above 0"));
  EXPECT_THAT(refusalOf([] { parse({"1", "--ao-radius"}); }), HasSubstr("--ao-radius: needs --ao"));
  EXPECT_THAT(refusalOf([] { parse({"half", "--ao-scale"}); }), HasSubstr("--ao-scale: needs --ao"));
  for (const char* form : {"5tap", "rays"})
    EXPECT_THAT(refusalOf([&] { parse({form, "--ao"}); }), AllOf(HasSubstr(form), HasSubstr("--ao-radius")));
  EXPECT_THAT(refusalOf([] { parse({"cones", "--ao"}, "", false); }), HasSubstr("--world-field off"));
  EXPECT_THAT(refusalOf([] { parse({}, "ao"); }), AllOf(HasSubstr("--view: ao"), HasSubstr("--ao")));
}

} // namespace
} // namespace brickfield
