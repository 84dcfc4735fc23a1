// A cache that is no help: whatever stands where an entry or the folder should be, the picture is the same, the program
// ends, and says in one line what is wrong.
#include <fstream>
#include <functional>
#include <map>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/robustness/app/command_line_fixture.h"
#include "tests/support/data.h"

namespace brickfield::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class CacheFault : public CommandLine {
protected:
  ProgramResult render(const std::string& output, const fs::path& cache = "cache") const {
    return run({"render", "scene.gltf", "-o", output, "--size", "32x18", "--sdf", "all", "--resolution", "16",
                "--cache", cache.string()});
  }

  fs::path entry() const {
    std::vector<fs::path> entries;
    for (const auto& found : fs::directory_iterator(folder_ / "cache")) entries.push_back(found.path());
    EXPECT_EQ(entries.size(), 1u);
    return entries.at(0);
  }

  void expectOneWarning(const ProgramResult& result, const std::string& file, const std::string& what) const {
    EXPECT_EQ(result.exitCode, 0) << result.messages;
    EXPECT_THAT(result.messages, AllOf(StartsWith("brickfield: warning: " + file), HasSubstr(what)));
    EXPECT_EQ(std::count(result.messages.begin(), result.messages.end(), '\n'), 1) << result.messages;
  }
};

TEST_F(CacheFault, EntryThatCannotBeReadIsNamedAndBakedAnew) {
  const ProgramResult first = render("first.png");
  ASSERT_EQ(first.exitCode, 0) << first.messages;
  EXPECT_EQ(first.messages, "") << "an entry that is not there yet is nothing to warn of";
  const fs::path path = entry();
  const auto bytes = readFile(path);
  const std::map<std::string, std::function<void()>> faults = {
      {"pipe", [&] { ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0); }},
      {"socket", [&] { ASSERT_EQ(::mknod(path.c_str(), S_IFSOCK | 0600, 0), 0); }},
      {"folder", [&] { fs::create_directory(path); }},
      {"full folder", [&] { fs::create_directories(path / "inner"); }},
      {"link to nowhere", [&] { fs::create_symlink("nowhere", path); }},
      {"link to a device", [&] { fs::create_symlink("/dev/zero", path); }},
      {"empty", [&] { std::ofstream(path).flush(); }},
      {"truncated", [&] { writeFile(path, std::span(bytes).first(bytes.size() / 2)); }},
      {"garbage", [&] { std::ofstream(path) << "no bricks"; }},
  };
  for (const auto& [name, make] : faults) {
    SCOPED_TRACE(name);
    fs::remove_all(path);
    make();
    expectOneWarning(render("again.png"), "cache/" + path.filename().string(), "baked anew");
    EXPECT_EQ(readFile(folder_ / "again.png"), readFile(folder_ / "first.png"));
  }
  const bool isHealed = fs::is_regular_file(path);
  EXPECT_TRUE(isHealed) << "the last fault was a damaged file, which is replaced";
  EXPECT_EQ(render("again.png").messages, "");
}

TEST_F(CacheFault, EntryWithoutPermissionIsNamed) {
  if (::geteuid() == 0) return reportNotRun("root may read everything");
  ASSERT_EQ(render("first.png").exitCode, 0);
  fs::permissions(entry(), fs::perms::none);
  expectOneWarning(render("again.png"), "cache/", "Permission denied");
}

TEST_F(CacheFault, FolderThatHoldsNoCacheIsNamedOnce) {
  // Two fields, so that two entries cannot be stored.
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(folder_ / "scene.gltf"));
  for (const int node : {0, 1})
    scene["nodes"][node]["extras"]["brickfield"] = {{"sdf", true}, {"resolution", 8 + node}};
  writeFile(folder_ / "scene.gltf", scene.dump());
  const auto renderTo = [&](const fs::path& cache) {
    return run({"render", "scene.gltf", "-o", "a.png", "--size", "32x18", "--cache", cache.string()});
  };
  for (const char* cache : {"text.txt", "text.txt/cache", "/proc/cache", "/dev/null"}) {
    SCOPED_TRACE(cache);
    expectOneWarning(renderTo(cache), cache, "nothing is cached");
    EXPECT_TRUE(fs::is_regular_file(folder_ / "a.png"));
  }
  EXPECT_EQ(readFile(folder_ / "text.txt").size(), 8u);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  expectOneWarning(renderTo("pipe"), "pipe", "nothing is cached");
}

} // namespace
} // namespace brickfield::test
