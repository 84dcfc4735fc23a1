// Base64, data uris, and the walls around the glTF's folder.
#include "scene/gltf_uri.h"

#include <fstream>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {

namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class GltfUri : public ::testing::Test {
protected:
  void SetUp() override {
    base_ = fs::temp_directory_path() / ("brickfield_uri_" + std::to_string(::getpid()));
    fs::create_directories(base_ / "scene" / "inner");
    std::ofstream(base_ / "scene" / "inner" / "a b.bin") << "inside";
    std::ofstream(base_ / "outside.bin") << "outside";
    fs::create_symlink(base_ / "outside.bin", base_ / "scene" / "link.bin");
    fs::create_directory_symlink(base_, base_ / "scene" / "up");
  }
  void TearDown() override { fs::remove_all(base_); }

  std::string read(std::string_view uri, std::uint64_t limitBytes = 1000) const {
    const std::vector<std::byte> bytes =
        readUri(uri, {"scene.gltf", "buffer 0", base_ / "scene", limitBytes}, {"application/octet-stream"});
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::string error(std::string_view uri, std::uint64_t limitBytes = 1000) const {
    try {
      read(uri, limitBytes);
    } catch (const BadInput& error) {
      return error.what();
    }
    return {};
  }

  fs::path base_;
};

TEST_F(GltfUri, FilesBeneathTheFolderAreReadPercentDecoded) {
  EXPECT_EQ(read("inner/a%20b.bin"), "inside");
  EXPECT_EQ(read("./inner/a b.bin"), "inside");
}

TEST_F(GltfUri, WaysOutOfTheFolderAreRefused) {
  EXPECT_THAT(error("../outside.bin"), HasSubstr("leads out"));
  EXPECT_THAT(error("inner/../../outside.bin"), HasSubstr("leads out"));
  EXPECT_THAT(error("inner/../inner/a%20b.bin"), HasSubstr("leads out")) << "even where it comes back";
  EXPECT_THAT(error("%2e%2e/outside.bin"), HasSubstr("leads out"));
  EXPECT_THAT(error("%2e%2e%2foutside.bin"), HasSubstr("leads out"));
  EXPECT_THAT(error("link.bin"), HasSubstr("leads out")) << "a symbolic link";
  EXPECT_THAT(error("up/outside.bin"), HasSubstr("leads out")) << "a folder that is a symbolic link";
  EXPECT_THAT(error((base_ / "outside.bin").string()), HasSubstr("is absolute"));
  EXPECT_THAT(error("%2fdev%2fzero"), HasSubstr("is absolute"));
  EXPECT_THAT(error("/dev/zero"), HasSubstr("is absolute"));
  EXPECT_THAT(error("..\\outside.bin"), HasSubstr("backslash"));
}

TEST_F(GltfUri, SchemesAreRefused) {
  EXPECT_THAT(error("http://example.com/a.bin"), HasSubstr("has a scheme"));
  EXPECT_THAT(error("file:///etc/passwd"), HasSubstr("has a scheme"));
  EXPECT_THAT(error("%66ile:///etc/passwd"), HasSubstr("has a scheme"));
}

TEST_F(GltfUri, FoldersMissingFilesAndLargeOnesAreErrors) {
  EXPECT_THAT(error("inner"), HasSubstr("not a regular file"));
  EXPECT_THAT(error("."), HasSubstr("leads out"));
  EXPECT_THAT(error("missing.bin"), HasSubstr("uri \"missing.bin\": no such file"));
  EXPECT_THAT(error("inner/a%20b.bin", 5), HasSubstr("at most 5"));
  EXPECT_THAT(error(""), HasSubstr("is empty"));
  EXPECT_THAT(error("a%0"), HasSubstr("broken percent escape"));
  EXPECT_THAT(error("a%00b"), HasSubstr("zero byte"));
  EXPECT_THAT(error("missing.bin"), HasSubstr("scene.gltf: buffer 0: "));
}

TEST_F(GltfUri, DataUrisAreStrict) {
  EXPECT_EQ(read("data:application/octet-stream;base64,aGVsbG8="), "hello");
  EXPECT_EQ(read("data:application/octet-stream;x=y;base64,aGVsbG8"), "hello");
  EXPECT_THAT(error("data:text/html;base64,aGVsbG8="), HasSubstr("media type"));
  EXPECT_THAT(error("data:application/octet-stream,aGVsbG8="), HasSubstr("is not base64"));
  EXPECT_THAT(error("data:application/octet-stream;base64"), HasSubstr("has no comma"));
  EXPECT_THAT(error("data:application/octet-stream;base64,aGVs*G8="), HasSubstr("not valid base64"));
  EXPECT_THAT(error("data:application/octet-stream;base64,aGVsbG8=", 2), HasSubstr("too large"));
}

TEST(Base64, KnownVectorsOfRfc4648) {
  const auto decode = [](std::string_view text) -> std::string {
    std::vector<std::byte> bytes;
    if (!decodeBase64(text, bytes)) return "refused";
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  };
  EXPECT_EQ(decode(""), "");
  EXPECT_EQ(decode("Zg=="), "f");
  EXPECT_EQ(decode("Zm8="), "fo");
  EXPECT_EQ(decode("Zm9v"), "foo");
  EXPECT_EQ(decode("Zm9vYg=="), "foob");
  EXPECT_EQ(decode("Zm9vYmE="), "fooba");
  EXPECT_EQ(decode("Zm9vYmFy"), "foobar");
  EXPECT_EQ(decode("+/+/"), "\xFB\xFF\xBF");
  EXPECT_EQ(decode("Z"), "refused");
  EXPECT_EQ(decode("Zm9v===="), "refused");
  EXPECT_EQ(decode("Zm 9v"), "refused");
}

} // namespace

} // namespace brickfield
