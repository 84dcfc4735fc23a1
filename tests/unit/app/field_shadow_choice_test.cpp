// The flags of marched shadows, what they mean and what goes together.
#include "app/field_shadow_choice.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/shadow_methods.h"
#include "tests/support/refusal.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

FieldShadowChoice parse(std::vector<std::string> arguments) {
  CLI::App app;
  FieldShadowChoice choice;
  addFieldShadowOptions(app, choice);
  std::reverse(arguments.begin(), arguments.end()); // as CLI11 takes them
  app.parse(std::move(arguments));
  return choice;
}

TEST(FieldShadowChoice, FlagsBecomeSettings) {
  const FieldShadowChoice none = parse({});
  ShadowSettings usual;
  usual.penumbraRays = 10;
  EXPECT_EQ(none.settings, usual);
  EXPECT_TRUE(none.given.empty());
  const FieldShadowChoice all = parse({"--shadow-estimator", "umbra", "--shadow-rays", "4", "--shadow-softness", "0.5",
                                       "--shadow-resolution", "half", "--shadow-bricks", "512"});
  EXPECT_EQ(all.settings.estimator, ShadowEstimator::Umbra);
  EXPECT_EQ(all.settings.penumbraRays, 4);
  EXPECT_EQ(all.settings.softness, 0.5f);
  EXPECT_TRUE(all.settings.halfResolution);
  EXPECT_TRUE(all.settings.nearBricks);
  EXPECT_EQ(all.brickVoxels, 512);
  EXPECT_EQ(all.given.size(), 5u);
  EXPECT_FALSE(parse({"--shadow-bricks", "off"}).settings.nearBricks);
  EXPECT_EQ(parse({"--shadow-bricks", "objects"}).brickVoxels, 0);
}

TEST(FieldShadowChoice, EstimatorsHaveNames) {
  for (const char* name : {"rays", "hard", "min-ratio", "coverage", "rtsdf", "umbra"})
    EXPECT_STREQ(estimatorName(parseEstimator("--shadow-estimator", name)), name);
}

TEST(FieldShadowChoice, RefusesWhatIsOutOfRange) {
  const auto refuses = [](const std::string& flag, const std::string& text) {
    EXPECT_THAT(refusalOf([&] { parse({flag, text}); }), AllOf(HasSubstr(flag), HasSubstr(text)));
  };
  refuses("--shadow-estimator", "best");
  refuses("--shadow-rays", "0");
  refuses("--shadow-rays", "65");
  refuses("--shadow-softness", "4.5");
  refuses("--shadow-resolution", "quarter");
  refuses("--shadow-bricks", "63");
  refuses("--shadow-bricks", "all");
}

TEST(FieldShadowChoice, RefusesWhatDoesNotGoTogether) {
  const auto check = [](std::vector<std::string> arguments, bool isMarched = true, bool isExact = true) {
    return refusalOf([&] { checkFieldShadowChoice(parse(std::move(arguments)), isMarched, isExact); });
  };
  EXPECT_EQ(check({}, false), "accepted");
  EXPECT_THAT(check({"--shadow-rays", "4"}, false), AllOf(HasSubstr("--shadow-rays"), HasSubstr("--shadows field")));
  EXPECT_THAT(check({"--shadow-estimator", "hard", "--shadow-rays", "4"}), HasSubstr("--shadow-rays"));
  EXPECT_EQ(check({"--shadow-estimator", "umbra", "--shadow-rays", "4"}), "accepted");
  EXPECT_THAT(check({"--shadow-estimator", "rtsdf", "--shadow-bricks", "256"}), HasSubstr("--shadow-bricks"));
  EXPECT_THAT(check({"--shadow-bricks", "256"}, true, false), HasSubstr("--world-field exact"));
  EXPECT_EQ(check({"--shadow-bricks", "off"}, true, false), "accepted");
}

// The bench has every estimator, each under a name of its own.
TEST(FieldShadowChoice, EveryEstimatorIsBenched) {
  std::set<ShadowEstimator> estimators;
  std::set<std::string> names;
  for (const BenchedShadows& method : benchedShadows()) {
    if (method.settings.method == ShadowMethod::Field) estimators.insert(method.settings.estimator);
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_EQ(findBenchedShadows(method.name), &method);
  }
  EXPECT_EQ(estimators.size(), 6u);
  EXPECT_EQ(findBenchedShadows("nothing"), nullptr);
}

} // namespace
} // namespace brickfield
