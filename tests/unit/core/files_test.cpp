// Whole files: what is read, what is refused, and that a failed write leaves what was there.
#include "core/files.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string textOf(const fs::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
std::ptrdiff_t entriesOf(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}
template <typename Act>
std::string refusalOf(Act act) {
  try {
    act();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

TEST(ReadFile, GivesEveryByte) {
  const TemporaryFolder folder;
  const std::string text("a\0\n\xff", 4);
  writeFile(folder / "bytes", text);
  EXPECT_EQ(textOf(folder / "bytes"), text);
  writeFile(folder / "empty", std::string_view());
  EXPECT_EQ(textOf(folder / "empty"), "");
}

TEST(ReadFile, RefusesWhatIsNoFileAndNamesIt) {
  const TemporaryFolder folder;
  for (const fs::path& path : {folder / "missing.glb", folder.path(), fs::path("/dev/zero"), fs::path("")})
    EXPECT_THAT(refusalOf([&] { readFile(path); }), AllOf(HasSubstr(path.string() + ":"))) << path;
}

/// A named pipe, a socket's name and links to them: what a plain open would wait on for ever, or fail at.
std::vector<fs::path> notFiles(const TemporaryFolder& folder) {
  EXPECT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(::mknod((folder / "socket").c_str(), S_IFSOCK | 0600, 0), 0);
  fs::create_symlink("pipe", folder / "link");
  return {folder / "pipe", folder / "socket", folder / "link"};
}

TEST(ReadFile, RefusesPipesAndSocketsWithoutWaiting) {
  const TemporaryFolder folder;
  for (const fs::path& path : notFiles(folder))
    EXPECT_THAT(refusalOf([&] { readFile(path); }), AllOf(HasSubstr(path.string() + ":"), HasSubstr("not a regular")));
  EXPECT_THAT(refusalOf([&] { readFile(folder / "pipe", 9, "scene.gltf: buffer 0"); }),
              "scene.gltf: buffer 0: is a named pipe, not a regular file");
}

TEST(ReadFile, RefusesFilesOverTheLimit) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("ten", "0123456789");
  EXPECT_EQ(readFile(path, 10).size(), 10u);
  EXPECT_THAT(refusalOf([&] { readFile(path, 9); }), AllOf(HasSubstr("ten"), HasSubstr("9")));
}

TEST(WriteFile, ReplacesWhatWasThere) {
  const TemporaryFolder folder;
  writeFile(folder / "file", std::string_view("a much longer text"));
  writeFile(folder / "file", std::string_view("new"));
  EXPECT_EQ(textOf(folder / "file"), "new");
  EXPECT_EQ(entriesOf(folder.path()), 1);
}

TEST(WriteBesideAndRename, FailureLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("file.bin", "old");
  EXPECT_THROW(writeBesideAndRename(path,
                                    [](const fs::path& beside) {
                                      std::ofstream(beside) << "half";
                                      throw Cancelled();
                                    }),
               Cancelled);
  EXPECT_EQ(textOf(path), "old");
  EXPECT_EQ(entriesOf(folder.path()), 1);
}

TEST(WriteBesideAndRename, WriterThatWritesNothingIsAnErrorAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("file.bin", "old");
  EXPECT_THAT(refusalOf([&] { writeBesideAndRename(path, [](const fs::path&) {}); }), HasSubstr("file.bin"));
  EXPECT_EQ(textOf(path), "old");
}

TEST(WriteBesideAndRename, TargetIsUntouchedUntilTheEnd) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("file.bin", "old");
  writeBesideAndRename(path, [&](const fs::path& beside) {
    EXPECT_EQ(beside.extension(), ".bin");
    EXPECT_EQ(beside.parent_path(), folder.path());
    std::ofstream(beside) << "new";
    EXPECT_EQ(textOf(path), "old");
  });
  EXPECT_EQ(textOf(path), "new");
}

TEST(WriteFile, RefusesFoldersAndMissingParents) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  for (const fs::path& path : {folder / "sub", folder / "sub/", folder / "no/such/file"})
    EXPECT_THAT(refusalOf([&] { writeFile(path, std::string_view("x")); }), HasSubstr(path.string())) << path;
  EXPECT_EQ(entriesOf(folder.path()), 1);
}

TEST(WriteFile, WritesThroughDevicesInsteadOfReplacingThem) {
  writeFile("/dev/null", std::string_view("x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  if (fs::exists("/dev/full")) {
    EXPECT_THAT(refusalOf([] { writeFile("/dev/full", std::string_view("x")); }), HasSubstr("/dev/full"));
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
  }
}

TEST(WriteFile, RefusesPipesAndSocketsWithoutWaiting) {
  const TemporaryFolder folder;
  for (const fs::path& path : notFiles(folder)) {
    EXPECT_THAT(refusalOf([&] { writeFile(path, std::string_view("x")); }),
                AllOf(HasSubstr(path.string() + ":"), HasSubstr("not written to")));
    EXPECT_THAT(obstacleToWriting(path), HasSubstr("not written to"));
  }
  EXPECT_EQ(entriesOf(folder.path()), 3);
}

TEST(WriteFile, KeepsSymbolicLinksAndReplacesWhatTheyLeadTo) {
  const TemporaryFolder folder;
  folder.write("inner/file", "old");
  fs::create_symlink("inner/file", folder / "link");
  writeFile(folder / "link", std::string_view("new"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(textOf(folder / "inner/file"), "new");
}

TEST(ObstacleToWriting, IsFoundBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  folder.write("file", "old");
  EXPECT_EQ(obstacleToWriting(folder / "file"), "");
  EXPECT_EQ(obstacleToWriting(folder / "new"), "");
  EXPECT_EQ(obstacleToWriting("/dev/null"), "");
  EXPECT_THAT(obstacleToWriting(folder.path()), HasSubstr("folder"));
  EXPECT_THAT(obstacleToWriting(folder / "no/file"), HasSubstr("folder does not exist"));
  EXPECT_THAT(obstacleToWriting(folder / std::string(300, 'n')), HasSubstr("too long"));
  EXPECT_THAT(obstacleToWriting("/proc/file"), HasSubstr("cannot be written")) << "where root may, but nobody can";
  EXPECT_EQ(entriesOf(folder.path()), 1);
  EXPECT_EQ(textOf(folder / "file"), "old");
}

TEST(WriteFile, LongNamesThatTheFolderTakesAreWritten) {
  const TemporaryFolder folder;
  const std::string name = std::string(250, 'n') + ".png";
  writeFile(folder / name, std::string_view("x"));
  EXPECT_EQ(textOf(folder / name), "x");
}

TEST(ExecutableFolder, HoldsThisTest) {
  EXPECT_TRUE(fs::is_directory(executableFolder()));
  EXPECT_TRUE(std::any_of(fs::directory_iterator(executableFolder()), fs::directory_iterator(), [](const auto& entry) {
    return entry.path().filename().string().find("test_unit_core") == 0;
  }));
}

} // namespace
} // namespace brickfield::test
