// Radiance pictures against hand-coded bytes; hostile ones end in one line, never in a loop.
#include "app/environment_io.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/image_io.h"
#include "core/files.h"
#include "tests/support/data.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::HasSubstr;
using namespace std::string_literals;

const std::string kHead = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n";

Environment decode(const std::string& file) { return decodeRadianceHdr(std::as_bytes(std::span(file)), "test.hdr"); }

/// 16 x 1: red is one run of 16 times 128, green two literals runs, blue zero, exponent 129 (scale 2^-7).
std::string runCoded() {
  std::string line = "\x02\x02\x00\x10"s;
  line += "\x90\x80"s;                                     // run of 16
  line += "\x08\x00\x10\x20\x30\x40\x50\x60\x70\x88\x40"s; // 8 literals, run of 8
  line += "\x90\x00\x90\x81"s;
  return kHead + "-Y 1 +X 16\n" + line;
}

TEST(RadianceHdr, DecodesFlatPixels) {
  // 136 is 128 + 8: mantissas count whole units.
  const Environment environment = decode(kHead + "-Y 1 +X 2\n" + "\x01\x02\x03\x88\x80\x40\x00\x80"s);
  ASSERT_EQ(environment.size, glm::uvec2(2, 1));
  EXPECT_EQ(environment.radiance[0], glm::vec3(1, 2, 3));
  EXPECT_EQ(environment.radiance[1], glm::vec3(0.5f, 0.25f, 0));
}

TEST(RadianceHdr, DecodesRuns) {
  const Environment environment = decode(runCoded());
  ASSERT_EQ(environment.size, glm::uvec2(16, 1));
  EXPECT_EQ(environment.radiance[0], glm::vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(environment.radiance[7], glm::vec3(1.0f, 0.875f, 0.0f));
  EXPECT_EQ(environment.radiance[15], glm::vec3(1.0f, 0.5f, 0.0f));
}

TEST(RadianceHdr, RefusesEveryTruncation) {
  const std::string whole = runCoded();
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THAT(refusalOf([&] { decode(whole.substr(0, length)); }), HasSubstr("test.hdr: ")) << length;
}

TEST(RadianceHdr, RefusesRunsThatLeaveTheLineOrDoNotAdvance) {
  std::string file = runCoded();
  const std::size_t firstRun = kHead.size() + "-Y 1 +X 16\n"s.size() + 4;
  file[firstRun] = '\x91'; // 17 of 16
  EXPECT_THAT(refusalOf([&] { decode(file); }), HasSubstr("leaves its line"));
  file = runCoded();
  file.insert(firstRun, 1, '\0'); // all else as it was: only the empty run is wrong
  EXPECT_THAT(refusalOf([&] { decode(file); }), HasSubstr("leaves its line"));
}

TEST(RadianceHdr, RefusesHeadersThatAreNone) {
  const auto refusal = [](const std::string& file) { return refusalOf([&] { decode(file); }); };
  EXPECT_THAT(refusal("P6\n1 1\n255\n"), HasSubstr("not a Radiance picture"));
  EXPECT_THAT(refusal("#?RADIANCE\n\n-Y 1 +X 1\n1234"), HasSubstr("names no FORMAT"));
  EXPECT_THAT(refusal("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"), HasSubstr("XYZE"));
  for (const char* size :
       {"+Y 1 +X 1", "-Y 0 +X 1", "-Y 1 +X 16385", "-Y 99999999999 +X 1", "-Y a +X b", "-Y 1 +X 1 ", ""})
    EXPECT_THAT(refusal(kHead + size + "\n1234"), HasSubstr("test.hdr: ")) << size;
  EXPECT_THAT(refusal(kHead + "-Y 8192 +X 16384\n" + "1234"), HasSubstr("truncated"));
}

TEST(ReadEnvironment, ClampsNegativesAndRefusesWhatIsNotFinite) {
  const test::TemporaryFolder folder;
  writeExr(folder / "a.exr", {{2, 1}, {{-1, 2, 3}, {4, 5, 6}}});
  const Environment environment = readEnvironment(folder / "a.exr");
  EXPECT_EQ(environment.radiance[0], glm::vec3(0, 2, 3));
  EXPECT_EQ(environment.radiance[1], glm::vec3(4, 5, 6));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e13f}) {
    writeExr(folder / "bad.exr", {{2, 1}, {{1, 2, 3}, {1, bad, 1}}});
    EXPECT_THAT(refusalOf([&] { readEnvironment(folder / "bad.exr"); }), HasSubstr("bad.exr: pixel 1,0: "));
  }
  writeExr(folder / "square.exr", {{1, 1}, {{1, 2, 3}}});
  EXPECT_THAT(refusalOf([&] { readEnvironment(folder / "square.exr"); }), HasSubstr("twice as wide"));
}

TEST(ReadEnvironment, ReadsARealPicture) {
  BRICKFIELD_NEEDS_DATA("studio_1k.hdr");
  const Environment environment = readEnvironment(test::dataFile("studio_1k.hdr"));
  EXPECT_EQ(environment.size, glm::uvec2(1024, 512));
  float peak = 0;
  for (const glm::vec3& radiance : environment.radiance)
    peak = std::max(peak, std::max({radiance.x, radiance.y, radiance.z}));
  EXPECT_NEAR(peak, 3568.0f, 8.0f); // as the data's own list says; its mantissa has eight bits
}

} // namespace
} // namespace brickfield
