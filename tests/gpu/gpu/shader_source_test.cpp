// Include resolution, and compiler logs turned back into files. No context is needed.
#include "gpu/shader_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class ShaderSource : public ::testing::Test {
protected:
  ShaderText assemble(std::string_view path) const { return assembleShader(folder.path(), path, {}); }
  std::string failure(std::string_view path) const {
    try {
      assemble(path);
    } catch (const Failure& error) {
      return error.what();
    }
    return "no failure";
  }
  TemporaryFolder folder;
};

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(ShaderSource, PreambleStandsInFront) {
  folder.write("a.glsl", "void main() {}\n");
  const ShaderText text =
      assembleShader(folder.path(), "a.glsl", {{"GL_ARB_shader_draw_parameters"}, {{"STEPS", "64"}, {"FAST", ""}}});
  EXPECT_EQ(text.text, "#version 450 core\n#extension GL_ARB_shader_draw_parameters : require\n"
                       "#define BRICKFIELD_GLSL 1\n#define FAST \n#define STEPS 64\n#line 1 0\nvoid main() {}\n");
  EXPECT_THAT(text.files, ElementsAre("a.glsl"));
}

TEST_F(ShaderSource, IncludesEnterOnceInPlaceWithLines) {
  folder.write("lib/noise.glsl", "float noise();\n");
  folder.write("lib/light.glsl", "#include \"lib/noise.glsl\"\nfloat light();\n");
  folder.write("passes/a.frag.glsl",
               "// a pass\n#include \"lib/light.glsl\"\n  #  include \"lib/noise.glsl\" // again\nvoid main() {}");
  const ShaderText text = assemble("passes/a.frag.glsl");
  EXPECT_THAT(text.files, ElementsAre("passes/a.frag.glsl", "lib/light.glsl", "lib/noise.glsl"));
  EXPECT_EQ(text.text, "#version 450 core\n#define BRICKFIELD_GLSL 1\n#line 1 0\n// a pass\n#line 1 1\n#line 1 2\n"
                       "float noise();\n#line 2 1\nfloat light();\n#line 3 0\n#line 4 0\nvoid main() {}\n");
}

TEST_F(ShaderSource, CommentsIncludeNothing) {
  folder.write("a.glsl",
               "// #include \"none.glsl\"\n/* x\n#include \"none.glsl\"\n*/ int a; /* y */\n#define B 1 // c\n");
  EXPECT_THAT(assemble("a.glsl").files, ElementsAre("a.glsl"));
}

TEST_F(ShaderSource, SharedHeaderServesBothLanguages) {
  folder.write("shared/types.h",
               "#pragma once\n#ifdef __cplusplus\n#include <glm/glm.hpp>\n#include \"core/math.h\"\n#else\n"
               "#include \"lib/a.glsl\"\n#endif\nstruct S { int a; };\n");
  folder.write("lib/a.glsl", "#ifndef A_H\n#define A_H\n#include \"lib/b.glsl\"\n#endif\n");
  folder.write("lib/b.glsl", "const int b = 1;\n");
  folder.write("a.glsl", "#include \"shared/types.h\"\n");
  const ShaderText text = assemble("a.glsl");
  EXPECT_THAT(text.files, ElementsAre("a.glsl", "shared/types.h", "lib/a.glsl", "lib/b.glsl"));
  EXPECT_THAT(text.text, Not(HasSubstr("#include")));
  EXPECT_THAT(text.text, Not(HasSubstr("#pragma")));
  EXPECT_EQ(countOf(text.text, "const int b"), 1u);
}

TEST_F(ShaderSource, MissingIncludeNamesFileAndLine) {
  folder.write("a.glsl", "int a;\n#include \"lib/none.glsl\"\n");
  EXPECT_THAT(failure("a.glsl"), HasSubstr("a.glsl:2: "));
  EXPECT_THAT(failure("a.glsl"), HasSubstr("lib/none.glsl: no such file"));
  EXPECT_THAT(failure("none.glsl"), HasSubstr("none.glsl: no such file"));
}

TEST_F(ShaderSource, CycleShowsItsChain) {
  folder.write("a.glsl", "#include \"b.glsl\"\n");
  folder.write("b.glsl", "\n#include \"c.glsl\"\n");
  folder.write("c.glsl", "\n\n#include \"b.glsl\"\n");
  EXPECT_EQ(failure("a.glsl"), "c.glsl:3: include cycle b.glsl -> c.glsl -> b.glsl");
  folder.write("self.glsl", "#include \"self.glsl\"\n");
  EXPECT_EQ(failure("self.glsl"), "self.glsl:1: include cycle self.glsl -> self.glsl");
}

TEST_F(ShaderSource, PathsStayBelowTheRoot) {
  folder.write("up.glsl", "#include \"../secret.glsl\"\n");
  folder.write("absolute.glsl", "#include \"/etc/hostname\"\n");
  folder.write("winding.glsl", "#include \"lib/../up.glsl\"\n"); // would enter a file under two names
  folder.write("lib/a.glsl", "");
  for (const std::string path : {"up.glsl", "absolute.glsl", "winding.glsl"}) {
    EXPECT_THAT(failure(path), HasSubstr(path + ":1: "));
    EXPECT_THAT(failure(path), HasSubstr("is no plain path below"));
  }
}

TEST_F(ShaderSource, WrongDirectivesNameFileAndLine) {
  folder.write("condition.glsl", "#if FAST\n#include \"b.glsl\"\n#endif\n");
  folder.write("version.glsl", "\n#version 330\n");
  folder.write("bare.glsl", "#include b.glsl\n");
  folder.write("open.glsl", "#ifdef A\nint a;\n");
  EXPECT_THAT(failure("condition.glsl"), HasSubstr("condition.glsl:2: "));
  EXPECT_THAT(failure("version.glsl"), HasSubstr("version.glsl:2: "));
  EXPECT_THAT(failure("bare.glsl"), HasSubstr("bare.glsl:1: "));
  EXPECT_THAT(failure("open.glsl"), HasSubstr("open.glsl: "));
}

TEST_F(ShaderSource, VisitedHoldsMissingFilesToo) {
  folder.write("a.glsl", "#include \"b.glsl\"\n");
  FileTimes visited;
  EXPECT_THROW(assembleShader(folder.path(), "a.glsl", {}, &visited), Failure);
  ASSERT_EQ(visited.size(), 2u);
  EXPECT_EQ(visited.at("b.glsl"), std::filesystem::file_time_type::min());
  EXPECT_EQ(visited.at("a.glsl"), changeTime(folder / "a.glsl"));
}

TEST(ReadableLog, KnowsTheFormsOfDrivers) {
  const std::vector<std::string> files = {"a.glsl", "lib/b.glsl"};
  EXPECT_THAT(readableLog("1:12(3): error: syntax error\n0:4(1): warning: x\n", files),
              ElementsAre("lib/b.glsl:12: error: syntax error", "a.glsl:4: warning: x"));
  EXPECT_THAT(readableLog("1(12) : error C1008: undefined variable \"q\"\n", files),
              ElementsAre("lib/b.glsl:12: error C1008: undefined variable \"q\""));
  EXPECT_THAT(readableLog("ERROR: 0:7: 'q' : undeclared\r\nWARNING: 1:2: w\n", files),
              ElementsAre("a.glsl:7: error: 'q' : undeclared", "lib/b.glsl:2: warning: w"));
}

TEST(ReadableLog, KeepsWhatItCannotPlace) {
  EXPECT_THAT(readableLog("error: linking\n\n9:1(1): error: x\n99999999999999999999:1: y\n", {"a.glsl"}),
              ElementsAre("error: linking", "9:1(1): error: x", "99999999999999999999:1: y"));
  EXPECT_EQ(readableLog("0:1(1): error: " + std::string(1 << 20, 'x'), {"a.glsl"}).at(0).substr(0, 17),
            "a.glsl:1: error: ");
}

} // namespace
} // namespace brickfield::test
