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

TEST(ShadowChoice, RenderHasFieldAndNoneAndSaysSo) {
  EXPECT_EQ(parse(addRenderShadows, {}), ShadowChoice::None);
  EXPECT_EQ(parse(addRenderShadows, {"none", "--shadows"}), ShadowChoice::None);
  EXPECT_EQ(parse(addRenderShadows, {"field", "--shadows"}), ShadowChoice::Field);
  for (const char* kind : {"csm", "csm+field"})
    EXPECT_THAT(refusalOf([&] {
                  parse(addRenderShadows, {kind, "--shadows"});
                }),
                AllOf(HasSubstr("--shadows: "), HasSubstr(kind), HasSubstr("not drawn"), HasSubstr("none")));
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
