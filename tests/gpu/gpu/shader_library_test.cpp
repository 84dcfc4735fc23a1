// Programs from files: errors name file and line, the cache, reload, and where shaders are looked for.
#include "gpu/shader_library.h"

#include <cstdlib>

#include <gmock/gmock.h>

#include "core/error.h"
#include "core/files.h"
#include "gpu/buffer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ShaderLibraryTest : public GlTest {
protected:
  // A file's time may tick coarser than a test runs, so every rewrite sets a later one.
  void rewrite(std::string_view name, std::string_view text) {
    later_ += std::chrono::seconds(10);
    fs::last_write_time(folder.write(name, text), fs::file_time_type::clock::now() + later_);
  }
  static int run(const Program& program) {
    const Buffer result("result", std::vector<int>{0});
    result.bindStorage(0);
    program.dispatchOver({1, 1, 1});
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return result.read<int>().front();
  }
  static ProgramSource compute(std::map<std::string, std::string> defines = {}) {
    return {"answer", {{GL_COMPUTE_SHADER, "answer.comp.glsl"}}, std::move(defines), {}};
  }
  void SetUp() override {
    GlTest::SetUp();
    folder.write("lib/value.glsl", "int value() { return 41; }\n");
    folder.write("answer.comp.glsl",
                 "#include \"lib/value.glsl\"\n#ifndef PLUS\n#define PLUS 1\n#endif\n"
                 "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Result { int result; };\n"
                 "void main() { result = value() + PLUS; }\n");
  }
  std::string failure(ShaderLibrary& library, const ProgramSource& source) {
    try {
      library.load(source);
    } catch (const Failure& error) {
      return error.what();
    }
    return "no failure";
  }

  TemporaryFolder folder;

private:
  std::chrono::seconds later_{0};
};

TEST_F(ShaderLibraryTest, ProgramRunsWithItsDefines) {
  ShaderLibrary library(folder.path());
  EXPECT_EQ(run(*library.load(compute())), 42);
  EXPECT_EQ(run(*library.load(compute({{"PLUS", "9"}}))), 50);
  EXPECT_EQ(library.programCount(), 2u);
}

TEST_F(ShaderLibraryTest, SameSourceIsTheSameProgram) {
  ShaderLibrary library(folder.path());
  const auto first = library.load(compute());
  ProgramSource renamed = compute();
  renamed.label = "another name";
  EXPECT_EQ(library.load(renamed), first);
  EXPECT_NE(library.load(compute({{"PLUS", "2"}})), first);
}

TEST_F(ShaderLibraryTest, CompileErrorNamesFileAndLineOfTheInclude) {
  folder.write("lib/value.glsl", "// one\n// two\nint value() { return undeclaredName; }\n");
  ShaderLibrary library(folder.path());
  const std::string text = failure(library, compute());
  EXPECT_THAT(text, HasSubstr("\"answer\""));
  EXPECT_THAT(text, HasSubstr("lib/value.glsl:3: "));
  EXPECT_THAT(text, HasSubstr("undeclaredName"));
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  EXPECT_EQ(library.programCount(), 0u);
}

TEST_F(ShaderLibraryTest, LineNumbersHoldAfterAnInclude) {
  folder.write("answer.comp.glsl",
               "\n#include \"lib/value.glsl\"\n\nlayout(local_size_x = 1) in;\nvoid main() { oops; }\n");
  ShaderLibrary library(folder.path());
  EXPECT_THAT(failure(library, compute()), HasSubstr("answer.comp.glsl:5: "));
}

TEST_F(ShaderLibraryTest, LinkErrorIsAFailure) {
  folder.write("a.vert.glsl", "out vec3 color;\nvoid main() { color = vec3(1); gl_Position = vec4(0); }\n");
  folder.write("a.frag.glsl", "in vec2 color;\nout vec4 result;\nvoid main() { result = color.xyxy; }\n");
  ShaderLibrary library(folder.path());
  EXPECT_THAT(
      failure(library, {"mismatch", {{GL_VERTEX_SHADER, "a.vert.glsl"}, {GL_FRAGMENT_SHADER, "a.frag.glsl"}}, {}, {}}),
      HasSubstr("program \"mismatch\": linking: "));
}

TEST_F(ShaderLibraryTest, UnknownExtensionIsAFailure) {
  ShaderLibrary library(folder.path());
  ProgramSource source = compute();
  source.extensions = {"GL_BRICKFIELD_no_such_extension"};
  EXPECT_THAT(failure(library, source), HasSubstr("GL_BRICKFIELD_no_such_extension"));
}

TEST_F(ShaderLibraryTest, ReloadFollowsAChangedInclude) {
  ShaderLibrary library(folder.path());
  const auto program = library.load(compute());
  EXPECT_THAT(library.reloadChanged(), IsEmpty());
  rewrite("lib/value.glsl", "int value() { return 6; }\n");
  EXPECT_THAT(library.reloadChanged(), ElementsAre("reloaded answer"));
  EXPECT_EQ(run(*program), 7);
  EXPECT_THAT(library.reloadChanged(), IsEmpty());
}

TEST_F(ShaderLibraryTest, FailedReloadKeepsTheProgram) {
  ShaderLibrary library(folder.path());
  const auto program = library.load(compute());
  const GLuint before = program->id();
  rewrite("lib/value.glsl", "int value() { return; }\n");
  EXPECT_THAT(library.reloadChanged(), ElementsAre(HasSubstr("lib/value.glsl:1: ")));
  EXPECT_EQ(program->id(), before);
  EXPECT_EQ(run(*program), 42);
  EXPECT_THAT(library.reloadChanged(), IsEmpty()) << "the same error was reported twice";
  rewrite("lib/value.glsl", "int value() { return 1; }\n");
  EXPECT_THAT(library.reloadChanged(), ElementsAre("reloaded answer"));
  EXPECT_EQ(run(*program), 2);
}

TEST_F(ShaderLibraryTest, ReloadNoticesAMissingIncludeThatAppears) {
  ShaderLibrary library(folder.path());
  const auto program = library.load(compute());
  fs::remove(folder / "lib/value.glsl");
  EXPECT_THAT(library.reloadChanged(), ElementsAre(HasSubstr("lib/value.glsl: no such file")));
  EXPECT_THAT(library.reloadChanged(), IsEmpty());
  EXPECT_EQ(run(*program), 42);
  rewrite("lib/value.glsl", "int value() { return 2; }\n");
  EXPECT_THAT(library.reloadChanged(), ElementsAre("reloaded answer"));
  EXPECT_EQ(run(*program), 3);
}

TEST_F(ShaderLibraryTest, ReloadSetsUniformsAnew) {
  folder.write("answer.comp.glsl",
               "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Result { int result; };\n"
               "uniform int first;\nvoid main() { result = first; }\n");
  ShaderLibrary library(folder.path());
  const auto program = library.load(compute());
  program->set("first", 5);
  EXPECT_EQ(run(*program), 5);
  rewrite("answer.comp.glsl",
          "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer Result { int result; };\n"
          "uniform int a;\nuniform int first;\nvoid main() { result = 100 * a + first; }\n");
  library.reloadChanged();
  program->set("a", 1);
  program->set("first", 6); // a location kept from before the reload would hit `a`
  EXPECT_EQ(run(*program), 106);
}

TEST_F(ShaderLibraryTest, RootMustBeAFolder) {
  EXPECT_THROW(ShaderLibrary(folder / "none"), BadInput);
  EXPECT_THROW(ShaderLibrary(folder / "answer.comp.glsl"), BadInput);
}

TEST_F(ShaderLibraryTest, AllFilesAreListedSorted) {
  folder.write("shared/params.h", "");
  EXPECT_THAT(allShaderFiles(folder.path()), ElementsAre("answer.comp.glsl", "lib/value.glsl"));
  EXPECT_THROW(allShaderFiles(folder / "none"), BadInput);
  fs::create_directory_symlink(folder.path(), folder / "link");
  EXPECT_THAT(allShaderFiles(folder / "link"), ElementsAre("answer.comp.glsl", "lib/value.glsl"));
}

TEST(FindShaderRoot, VariableComesFirstAndMustBeRight) {
  const TemporaryFolder folder;
  ::setenv("BRICKFIELD_SHADERS", folder.path().c_str(), 1);
  EXPECT_EQ(findShaderRoot(), folder.path());
  ::setenv("BRICKFIELD_SHADERS", (folder / "none").c_str(), 1);
  EXPECT_THROW(findShaderRoot(), BadInput);
  ::unsetenv("BRICKFIELD_SHADERS");
}

TEST(FindShaderRoot, BuildFolderHasThem) {
  ::unsetenv("BRICKFIELD_SHADERS");
  try {
    EXPECT_TRUE(fs::equivalent(findShaderRoot(), fs::path(BRICKFIELD_SOURCE_DIR) / "shaders"));
  } catch (const BadInput& error) {
    // Only where no link lies beside the test is it right not to find them, and then both places are named.
    EXPECT_FALSE(fs::exists(executableFolder() / "shaders")) << error.what();
    EXPECT_THAT(error.what(), HasSubstr("share/brickfield/shaders"));
  }
}

} // namespace
} // namespace brickfield::test
