// Hostile files made on the spot: nesting, uris, bombs, wrong lengths, truncations and flipped bytes.
#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <string>

#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/robustness/scene/import_outcome.h"
#include "tests/support/data.h"

namespace brickfield::test {

namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::uint64_t kMemoryAllowed = std::uint64_t{1} << 30;

class MadeGltf : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("brickfield_hostile_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "inner");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, std::string_view text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  ImportOutcome importText(const std::string& text) const { return importApart(write("made.gltf", text)); }
  /// Members of a document with a valid asset.
  ImportOutcome importMembers(const std::string& members) const {
    return importText(R"({"asset":{"version":"2.0"},)" + members + "}");
  }
  void expectRefused(const ImportOutcome& outcome, const std::string& reason) const {
    EXPECT_STREQ(name(outcome.ending), "refused") << outcome.message;
    EXPECT_THAT(outcome.message, HasSubstr(reason));
    EXPECT_LT(outcome.peakBytes, kMemoryAllowed);
  }

  fs::path folder_;
};

std::string repeated(std::string_view text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int k = 3; k >= 0; --k) text += kDigits[bits >> (6 * k) & 63];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  for (std::size_t k = 0; k < padding; ++k) text[text.size() - 1 - k] = '=';
  return text;
}

void putBigEndian32(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

void putChunk(std::string& png, std::string_view type, std::string_view payload) {
  putBigEndian32(png, static_cast<std::uint32_t>(payload.size()));
  png += type;
  png += payload;
  putBigEndian32(png, 0); // no decoder in use here looks at the checksum
}

std::string pngOf(std::uint32_t width, std::uint32_t height, std::string_view compressed) {
  std::string png = "\x89PNG\r\n\x1a\n", header;
  putBigEndian32(header, width);
  putBigEndian32(header, height);
  header += std::string("\x08\x06\x00\x00\x00", 5); // 8 bits, RGBA
  putChunk(png, "IHDR", header);
  putChunk(png, "IDAT", compressed);
  putChunk(png, "IEND", "");
  return png;
}

/// Deflate with fixed codes: one zero byte, then `copies` times 258 more of it.
std::string zeroBomb(int copies) {
  std::string bytes = "\x78\x9c";
  std::uint32_t pending = 0;
  int count = 0;
  const auto put = [&](std::uint32_t bit) {
    pending |= bit << count;
    if (++count == 8) bytes += static_cast<char>(pending), pending = 0, count = 0;
  };
  const auto putCode = [&](std::uint32_t code, int length) {
    for (int i = length - 1; i >= 0; --i) put(code >> i & 1);
  };
  put(1), put(1), put(0);                                           // last block, fixed codes
  putCode(0x30, 8);                                                 // literal 0
  for (int i = 0; i < copies; ++i) putCode(0xC5, 8), putCode(0, 5); // length 258 at distance 1
  putCode(0, 7);                                                    // end
  while (count != 0) put(0);
  return bytes + std::string(4, '\0');
}

std::string usingImage(const std::string& image) {
  return R"("images":[{"name":"Bomb",)" + image +
         R"(}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}])";
}
std::string usingPng(std::string_view png) {
  return usingImage(R"("uri":"data:image/png;base64,)" + base64(png) + "\"");
}

TEST_F(MadeGltf, DeepNestingIsRefusedEverywhere) {
  constexpr int kDepth = 200'000;
  expectRefused(importText(repeated("[", kDepth)), "nested 200000 deep");
  expectRefused(importText(repeated("{\"a\":", kDepth)), "nested 200000 deep");
  expectRefused(importMembers("\"extras\":" + repeated("[", kDepth) + repeated("]", kDepth)), "nested 200001 deep");
  expectRefused(importMembers("\"extras\":" + repeated("{\"a\":", kDepth) + "1" + repeated("}", kDepth)),
                "nested 200001 deep");
}

TEST_F(MadeGltf, UrisLeadNowhereElse) {
  for (const char* uri :
       {".", "./", "inner", "inner/", "/dev/zero", "/dev/stdin", "../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd",
        "/etc/passwd", "file:///etc/passwd", "http://localhost/a.bin", "C:\\\\boot.ini", "", "made.gltf/x",
        "inner/../../x", "data:", "data:application/octet-stream;base64,!", "%", "a%00b"}) {
    const std::string quoted = std::string("\"") + uri + "\"";
    const ImportOutcome buffer = importMembers(R"("buffers":[{"byteLength":10,"uri":)" + quoted + "}]");
    expectRefused(buffer, "made.gltf: buffer 0: ");
    const ImportOutcome image = importMembers(usingImage("\"uri\":" + quoted));
    expectRefused(image, "made.gltf: image 0 \"Bomb\": ");
  }
  expectRefused(importMembers(R"("buffers":[{"byteLength":10,"uri":")" + std::string(100'000, 'a') + R"("}]})"),
                "made.gltf: ");
}

TEST_F(MadeGltf, SymbolicLinksDoNotLeadOut) {
  fs::create_symlink("/dev/zero", folder_ / "zero.bin");
  fs::create_symlink("/etc", folder_ / "etc");
  fs::create_symlink("loop.bin", folder_ / "loop.bin");
  expectRefused(importMembers(R"("buffers":[{"byteLength":10,"uri":"zero.bin"}])"), "leads out of the glTF's folder");
  expectRefused(importMembers(R"("buffers":[{"byteLength":10,"uri":"etc/passwd"}])"), "leads out of the glTF's folder");
  expectRefused(importMembers(R"("buffers":[{"byteLength":10,"uri":"loop.bin"}])"), "buffer 0");
}

TEST_F(MadeGltf, NamedPipesAreNotWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe.bin").c_str(), 0600), 0);
  expectRefused(importMembers(R"("buffers":[{"byteLength":10,"uri":"pipe.bin"}])"), "not a regular file");
  expectRefused(importApart(folder_ / "pipe.bin"), "not a regular file");
}

TEST_F(MadeGltf, ImagesOfImpossibleSizeAreRefusedByTheirHeader) {
  expectRefused(importMembers(usingPng(pngOf(60'000, 60'000, "x"))), "image 0 \"Bomb\"");
  expectRefused(importMembers(usingPng(pngOf(0x7FFFFFFF, 0x7FFFFFFF, "x"))), "image 0 \"Bomb\"");
  expectRefused(importMembers(usingPng(pngOf(0, 0, "x"))), "image 0 \"Bomb\"");
  expectRefused(importMembers(usingPng(pngOf(4, 16'385, "x"))), "4 x 16385 pixels, at most 16384 a side");
}

TEST_F(MadeGltf, ImagesThatInflateBeyondTheirSizeAreRefused) {
  // Four million times 258 bytes: a gigabyte out of seven megabytes, for an image of one pixel.
  expectRefused(importMembers(usingPng(pngOf(1, 1, zeroBomb(4'000'000)))), "cannot be decoded");
  const ImportOutcome honest = importMembers(usingPng(pngOf(64, 64, zeroBomb(64))));
  EXPECT_STREQ(name(honest.ending), "loaded") << honest.message << ": 258 * 64 + 1 bytes are the 64 rows of 257";
}

TEST_F(MadeGltf, CountsWithoutDataAreRefused) {
  const auto meshOf = [](const std::string& accessor) {
    return R"("accessors":[)" + accessor + R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])";
  };
  expectRefused(importMembers(meshOf(R"({"componentType":5126,"count":4000000000,"type":"VEC3"})")), "the limit");
  expectRefused(importMembers(meshOf(R"({"componentType":5126,"count":134217728,"type":"VEC3"})")),
                "without a bufferView");
  const std::string buffer =
      R"("buffers":[{"byteLength":4,"uri":"data:application/octet-stream;base64,AAAAAA=="}],"bufferViews":[{"buffer":0,"byteLength":4}],)";
  const std::string sparse =
      R"("sparse":{"count":2000000000,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}})";
  expectRefused(
      importMembers(buffer + meshOf(R"({"componentType":5126,"count":4000000000,"type":"VEC3",)" + sparse + "}")),
      "accessor 0 sparse indices: needs");
  expectRefused(importMembers(buffer + meshOf(R"({"componentType":5126,"count":3,"type":"VEC3",)" + sparse + "}")),
                "sparse values for 3 elements");
  expectRefused(
      importMembers(buffer + meshOf(R"({"bufferView":0,"componentType":5126,"count":4294967295,"type":"VEC3"})")),
      "accessor 0: needs");
}

TEST_F(MadeGltf, SharedAccessorsAreCountedForEachUse) {
  // A thousand primitives of 16 million vertices each cost a file nothing.
  const std::string primitive = R"({"attributes":{"POSITION":0,"NORMAL":0},"mode":6},)";
  std::string primitives = repeated(primitive, 1000);
  primitives.pop_back();
  const ImportOutcome outcome = importApart(write(
      "made.gltf",
      R"({"asset":{"version":"2.0"},"accessors":[{"componentType":5126,"count":4294967295,"type":"VEC3"}],"meshes":[{"primitives":[)" +
          primitives + "]}]}"));
  expectRefused(outcome, "the limit");
}

TEST_F(MadeGltf, HierarchiesOfAnyDepthAndCycles) {
  std::string chain = R"("nodes":[)";
  constexpr int kNodes = 100'000;
  for (int i = 0; i + 1 < kNodes; ++i) chain += R"({"children":[)" + std::to_string(i + 1) + "]},";
  EXPECT_STREQ(name(importMembers(chain + "{}]").ending), "loaded");
  expectRefused(importMembers(chain + R"({"children":[0]}]})"), "made.gltf: ");
  expectRefused(importMembers(chain + R"({"children":[0]}])"), "is its own ancestor");
}

TEST_F(MadeGltf, NoFileAtAll) {
  expectRefused(importText(""), "made.gltf: JSON");
  expectRefused(importText(std::string(1000, '\0')), "made.gltf: JSON");
  expectRefused(importText("null"), "not an object");
  expectRefused(importApart(folder_ / "missing.glb"), "no such file");
  expectRefused(importApart(folder_), "not a regular file");
}

std::string contentOf(const fs::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST_F(MadeGltf, TruncatedFilesAreRefusedAtEveryPlace) {
  for (const char* file : {"box.glb", "simple_skin.glb", "box_textured.glb"}) {
    BRICKFIELD_NEEDS_DATA(file);
    const std::string whole = contentOf(dataFile(file));
    for (std::size_t i = 0; i < 64; ++i) {
      const std::size_t length = whole.size() * i / 64;
      SCOPED_TRACE(std::string(file) + " cut to " + std::to_string(length));
      expectRefused(importApart(write("cut.glb", whole.substr(0, length))), "cut.glb: GLB: ");
      // The same with lengths that fit, so that what lies deeper is reached.
      if (length < 28) continue;
      std::string patched = whole.substr(0, length / 4 * 4);
      const auto patch = [&](std::size_t offset, std::size_t value) {
        for (std::size_t k = 0; k < 4; ++k) patched[offset + k] = static_cast<char>(value >> (8 * k) & 0xFF);
      };
      const std::size_t jsonBytes =
          static_cast<unsigned char>(whole[12]) + 256u * static_cast<unsigned char>(whole[13]);
      patch(8, patched.size());
      if (20 + jsonBytes + 8 <= patched.size())
        patch(20 + jsonBytes, patched.size() - 28 - jsonBytes);
      else
        patch(12, patched.size() - 20);
      expectRefused(importApart(write("cut.glb", patched)), "cut.glb: ");
    }
  }
}

TEST_F(MadeGltf, FlippedBytesEndInALoadOrALine) {
  for (const char* file : {"box.glb", "simple_skin.glb", "box_textured.glb", "animated_cube.glb"}) {
    BRICKFIELD_NEEDS_DATA(file);
    const std::string whole = contentOf(dataFile(file));
    std::mt19937 random(20240229); // the same flips in every run
    int refused = 0;
    for (int i = 0; i < 200; ++i) {
      std::string flipped = whole;
      // Half of them within the first kilobyte, where the JSON is.
      const std::size_t range = i % 2 ? whole.size() : std::min<std::size_t>(whole.size(), 1024);
      const std::size_t offset = random() % range;
      flipped[offset] = static_cast<char>(random() & 0xFF);
      const ImportOutcome outcome = importApart(write("flipped.glb", flipped));
      EXPECT_TRUE(outcome.ending == Ending::Loaded || outcome.ending == Ending::Refused)
          << file << ", flip " << i << " at " << offset << ": " << name(outcome.ending) << " " << outcome.message;
      EXPECT_LT(outcome.peakBytes, kMemoryAllowed);
      refused += outcome.ending == Ending::Refused;
      if (outcome.ending != Ending::Refused) continue;
      EXPECT_THAT(outcome.message, ::testing::StartsWith((folder_ / "flipped.glb").string() + ": "));
    }
    EXPECT_GT(refused, 40) << file;
    EXPECT_LT(refused, 200) << file;
  }
}

} // namespace

} // namespace brickfield::test
