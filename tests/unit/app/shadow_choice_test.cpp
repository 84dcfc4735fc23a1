// The words of --shadows for both commands.
#include "app/shadow_choice.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

using AddFlag = void (*)(CLI::App&, ShadowChoice&);

ShadowChoice parse(AddFlag add, std::vector<std::string> arguments) {
  CLI::App app;
  ShadowChoice choice{};
  add(app, choice);
  app.parse(std::move(arguments));
  return choice;
}

TEST(ShadowChoice, RenderHasFieldCsmBothAndNone) {
  EXPECT_EQ(parse(addRenderShadows, {}), ShadowChoice::None);
  EXPECT_EQ(parse(addRenderShadows, {"csm", "--shadows"}), ShadowChoice::Csm);
  EXPECT_EQ(parse(addRenderShadows, {"none", "--shadows"}), ShadowChoice::None);
  EXPECT_EQ(parse(addRenderShadows, {"field", "--shadows"}), ShadowChoice::Field);
  EXPECT_EQ(parse(addRenderShadows, {"csm+field", "--shadows"}), ShadowChoice::CsmField);
  EXPECT_STREQ(shadowName(ShadowChoice::CsmField), "csm+field");
  EXPECT_EQ(shadowMethodOf(ShadowChoice::CsmField), ShadowMethod::MapsAndField);
  EXPECT_EQ(shadowMethodOf(ShadowChoice::Csm), ShadowMethod::Maps);
  EXPECT_EQ(shadowMethodOf(ShadowChoice::Field), ShadowMethod::Field);
  for (const ShadowChoice choice : {ShadowChoice::None, ShadowChoice::Traced, ShadowChoice::Hard})
    EXPECT_EQ(shadowMethodOf(choice), ShadowMethod::None);
}

TEST(ShadowChoice, MapsHaveAFilterAndASize) {
  const auto mapsOf = [](std::vector<std::string> arguments) {
    CLI::App app;
    ShadowMapChoice choice;
    addShadowMapOptions(app, choice);
    app.parse(std::move(arguments));
    return choice.settings;
  };
  EXPECT_EQ(mapsOf({}), (ShadowMapSettings{ShadowFilter::Pcf, 2048}));
  EXPECT_EQ(mapsOf({"512", "--shadow-size", "evsm", "--shadow-filter"}), (ShadowMapSettings{ShadowFilter::Evsm, 512}));
  EXPECT_THAT(refusalOf([&] {
                mapsOf({"vsm", "--shadow-filter"});
              }),
              AllOf(HasSubstr("--shadow-filter: "), HasSubstr("vsm"), HasSubstr("neither pcf nor evsm")));
  for (const char* size : {"63", "8193", "-1", "many"})
    EXPECT_THAT(refusalOf([&] { mapsOf({size, "--shadow-size"}); }), HasSubstr("--shadow-size")) << size;
}

TEST(ShadowChoice, FlagsOfMapsNeedMaps) {
  for (const char* flag : {"--shadow-filter", "--shadow-size"}) {
    const ShadowMapChoice choice{{}, {flag}};
    EXPECT_NO_THROW(checkShadowMapChoice(choice, ShadowChoice::Csm));
    for (const ShadowChoice shadows : {ShadowChoice::None, ShadowChoice::Field})
      EXPECT_THAT(refusalOf([&] { checkShadowMapChoice(choice, shadows); }),
                  AllOf(HasSubstr(flag), HasSubstr("csm or csm+field")));
  }
  EXPECT_NO_THROW(checkShadowMapChoice({{}, {"--shadow-size"}}, ShadowChoice::CsmField));
  EXPECT_THAT(refusalOf([] {
                checkShadowMapChoice({{}, {"--shadow-filter"}}, ShadowChoice::CsmField);
              }),
              HasSubstr("filters nothing"));
  EXPECT_NO_THROW(checkShadowMapChoice({}, ShadowChoice::None));
}

TEST(ShadowChoice, ReferenceTracesUnlessToldNotTo) {
  EXPECT_EQ(parse(addReferenceShadows, {}), ShadowChoice::Traced);
  EXPECT_EQ(parse(addReferenceShadows, {"none", "--shadows"}), ShadowChoice::None);
  EXPECT_EQ(parse(addReferenceShadows, {"hard", "--shadows"}), ShadowChoice::Hard);
  EXPECT_THAT(refusalOf([] { parse(addRenderShadows, {"hard", "--shadows"}); }), HasSubstr("is none of"));
  for (const char* kind : {"field", "csm", "csm+field"})
    EXPECT_EQ(parse(addReferenceShadows, {kind, "--shadows"}), ShadowChoice::Traced) << kind;
}

TEST(ShadowChoice, OtherWordsAreRefused) {
  for (const AddFlag add : {addRenderShadows, addReferenceShadows})
    for (const char* word : {"", "soft", "None", "csm+fields"})
      EXPECT_THAT(refusalOf([&] {
                    parse(add, {word, "--shadows"});
                  }),
                  AllOf(HasSubstr("--shadows: "), HasSubstr("csm+field")))
          << word;
}

} // namespace
} // namespace brickfield
