// The flags of the world field: what they become, and which do not go together.
#include "app/field_choice.h"

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

FieldChoice parse(std::vector<std::string> arguments, const std::string& view = "", std::uint64_t seed = 0) {
  FieldChoice choice;
  CLI::App app;
  addFieldOptions(app, choice);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(std::move(arguments));
  settleFieldChoice(choice, view, seed);
  return choice;
}

TEST(FieldChoice, DefaultsAreTheSettings) {
  const FieldChoice choice = parse({});
  EXPECT_EQ(choice.settings.method, FieldMethod::Exact);
  EXPECT_EQ(choice.settings.shape, FieldShape{});
  EXPECT_EQ(choice.settings.shape.cascades, 4);
  EXPECT_EQ(choice.settings.shape.texels, 128);
  EXPECT_FALSE(choice.settings.always);
  RtsdfSettings rtsdf;
  rtsdf.seed = 0;
  EXPECT_EQ(choice.settings.rtsdf, rtsdf);
  EXPECT_EQ(choice.slice.axis, 1);
  EXPECT_FALSE(choice.slice.positionWorld);
  EXPECT_EQ(choice.slice.cascade, -1);
}

TEST(FieldChoice, ExactTakesCascadesOrOneVolume) {
  const FieldShape shape =
      parse({"--field-cascades", "2", "--field-texels", "256", "--field-texel", "0.125"}).settings.shape;
  EXPECT_EQ(shape, (FieldShape{2, 256, 0.125, false}));
  EXPECT_EQ(parse({"--field-size", "S"}).settings.shape, (FieldShape{1, 128, 0, true}));
  EXPECT_EQ(parse({"--field-size", "M"}).settings.shape, (FieldShape{1, 256, 0, true}));
  EXPECT_EQ(parse({"--field-size", "L"}).settings.shape, (FieldShape{1, 512, 0, true}));
}

TEST(FieldChoice, RtsdfTakesThePapersParameters) {
  const FieldSettings settings =
      parse({"--world-field", "rtsdf", "--field-size", "L", "--field-rays", "10", "--field-alpha", "0.5",
             "--field-mask", "inf", "--field-beta", "0.25", "--field-bias", "0"},
            "", (std::uint64_t{5} << 32) + 7)
          .settings;
  EXPECT_EQ(settings.method, FieldMethod::Rtsdf);
  EXPECT_EQ(settings.rtsdf.coarseSize, 256);
  EXPECT_EQ(settings.rtsdf.fineSize, 512);
  EXPECT_EQ(settings.rtsdf.raysPerTexel, 10);
  EXPECT_EQ(settings.rtsdf.decay, 0.5f);
  EXPECT_TRUE(std::isinf(settings.rtsdf.maskWidth));
  EXPECT_EQ(settings.rtsdf.beta, 0.25f);
  EXPECT_EQ(settings.rtsdf.bias, 0.0f);
  EXPECT_EQ(settings.rtsdf.seed, 5u ^ 7u) << "both halves of the seed count";
  EXPECT_EQ(parse({"--world-field", "rtsdf", "--field-mask", "0.5"}).settings.rtsdf.maskWidth, 0.5f);
  const FieldSettings brute =
      parse({"--field-brute-force", "--world-field", "rtsdf", "--field-rays", "1", "--field-bias", "0"}).settings;
  EXPECT_TRUE(brute.rtsdf.bruteForce);
}

TEST(FieldChoice, SliceNamesAxisAndPlace) {
  const FieldSlice slice = parse({"--slice", "z:-1.5", "--cascade", "3"}, "field").slice;
  EXPECT_EQ(slice.axis, 2);
  EXPECT_EQ(slice.positionWorld, -1.5);
  EXPECT_EQ(slice.cascade, 3);
  EXPECT_EQ(parse({"--slice", "x:0"}, "field-tiles").slice.axis, 0);
  EXPECT_EQ(parse({"--slice", "auto", "--cascade", "auto"}, "field-id").slice.axis, 1);
  EXPECT_EQ(parse({"--cascade", "0", "--world-field", "rtsdf"}, "field").slice.cascade, 0);
}

struct Refusal {
  std::vector<std::string> arguments;
  std::vector<std::string> named; ///< parts of the one line
  std::string view;
};

TEST(FieldChoice, WrongValuesAndCombinationsAreOneLine) {
  const std::vector<Refusal> refusals{
      {{"--world-field", "fast"}, {"--world-field", "fast", "exact, rtsdf and off"}, ""},
      {{"--field-cascades", "9"}, {"--field-cascades", "9"}, ""},
      {{"--field-cascades", "0"}, {"--field-cascades", "0"}, ""},
      {{"--field-texels", "96"}, {"--field-texels", "96", "power of two"}, ""},
      {{"--field-texels", "32"}, {"--field-texels", "32"}, ""},
      {{"--field-texels", "1024"}, {"--field-texels", "1024"}, ""},
      {{"--field-texel", "0"}, {"--field-texel", "0"}, ""},
      {{"--field-texel", "nan"}, {"--field-texel", "nan"}, ""},
      {{"--field-size", "XL"}, {"--field-size", "XL", "S, M and L"}, ""},
      {{"--field-size", "S", "--field-cascades", "2"}, {"--field-cascades", "one volume"}, ""},
      {{"--field-size", "S", "--field-texel", "1"}, {"--field-texel", "one volume"}, ""},
      {{"--field-rays", "5"}, {"--field-rays", "rtsdf"}, ""},
      {{"--field-brute-force"}, {"--field-brute-force", "rtsdf"}, ""},
      {{"--world-field", "rtsdf", "--field-rays", "65"}, {"--field-rays", "65"}, ""},
      {{"--world-field", "rtsdf", "--field-alpha", "1.5"}, {"--field-alpha", "1.5"}, ""},
      {{"--world-field", "rtsdf", "--field-mask", "-1"}, {"--field-mask", "-1"}, ""},
      {{"--world-field", "rtsdf", "--field-cascades", "2"}, {"--field-cascades", "exact", "--field-size"}, ""},
      {{"--world-field", "rtsdf", "--field-texel", "2"}, {"--field-texel", "exact"}, ""},
      {{"--world-field", "rtsdf", "--field-brute-force", "--field-alpha", "1"}, {"--field-alpha", "brute"}, ""},
      {{"--world-field", "rtsdf", "--field-brute-force", "--field-size", "S"}, {"--field-size", "400x200x400"}, ""},
      {{"--world-field", "off", "--field-rays", "5"}, {"--field-rays", "--world-field off"}, ""},
      {{"--world-field", "off", "--field-cascades", "2"}, {"--field-cascades", "--world-field off"}, ""},
      {{"--world-field", "off"}, {"--view", "field-surface", "--world-field off"}, "field-surface"},
      {{"--world-field", "rtsdf"}, {"--view", "field-id", "exact"}, "field-id"},
      {{"--world-field", "rtsdf"}, {"--view", "field-tiles", "exact"}, "field-tiles"},
      {{"--slice", "x:1"}, {"--slice", "views"}, ""},
      {{"--slice", "x:1"}, {"--slice", "views"}, "field-surface"},
      {{"--cascade", "1"}, {"--cascade", "views"}, "steps"},
      {{"--slice", "w:1"}, {"--slice", "w:1", "auto"}, "field"},
      {{"--slice", "x"}, {"--slice", "x"}, "field"},
      {{"--slice", ":1"}, {"--slice", ":1"}, "field"},
      {{"--slice", "x:1:2"}, {"--slice", "x:1:2"}, "field"},
      {{"--slice", "x:inf"}, {"--slice", "inf"}, "field"},
      {{"--cascade", "4"}, {"--cascade", "4", "counted from 0"}, "field"},
      {{"--cascade", "8"}, {"--cascade", "8"}, "field"},
      {{"--cascade", "1", "--field-size", "S"}, {"--cascade", "1"}, "field"},
      {{"--cascade", "1", "--world-field", "rtsdf"}, {"--cascade", "1"}, "field"},
  };
  for (const Refusal& refusal : refusals) {
    const std::string message = refusalOf([&] { parse(refusal.arguments, refusal.view); });
    for (const std::string& part : refusal.named)
      EXPECT_THAT(message, HasSubstr(part)) << refusal.arguments.front() << " " << refusal.arguments.back();
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

// The library says the same to a host that asks for what cannot be.
TEST(FieldSettings, AreCheckedByTheRendererToo) {
  const auto refusalWith = [](auto change) {
    RendererSettings settings;
    settings.view = "field";
    change(settings);
    return refusalOf([&] { checkSettings(settings); });
  };
  EXPECT_EQ(refusalWith([](RendererSettings&) {}), "accepted");
  EXPECT_THAT(refusalWith([](RendererSettings& s) { s.worldField.method = FieldMethod::Off; }), HasSubstr("off"));
  EXPECT_THAT(refusalWith([](RendererSettings& s) { s.fieldSlice.cascade = 4; }), HasSubstr("cascade 4"));
  EXPECT_THAT(refusalWith([](RendererSettings& s) { s.worldField.shape.cascades = 9; }), HasSubstr("cascades"));
  EXPECT_THAT(refusalWith([](RendererSettings& s) { s.worldField.shape.texels = 100; }), HasSubstr("texels"));
  EXPECT_THAT(refusalWith([](RendererSettings& s) { s.worldField.shape.texelSize = NAN; }), HasSubstr("texel size"));
  EXPECT_THAT(refusalWith([](RendererSettings& s) { s.worldField.rtsdf.raysPerTexel = 100; }), HasSubstr("rays"));
  EXPECT_THAT(refusalWith([](RendererSettings& s) {
                s.view = "field-id";
                s.worldField.method = FieldMethod::Rtsdf;
              }),
              AllOf(HasSubstr("field-id"), HasSubstr("rtsdf")));
}

} // namespace
} // namespace brickfield
