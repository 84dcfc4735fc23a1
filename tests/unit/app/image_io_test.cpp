// Pictures to files and back; what is refused before any work.
#include "app/image_io.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/tone_curve.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr float kHalfCode = 0.5f / 255.0f + 1e-6f; // rounding to 8 bits

TEST(Png, RoundTripIsExactToHalfACode) {
  const test::TemporaryFolder folder;
  RgbImage image{{5, 3}, {}};
  for (int i = 0; i < 15; ++i) image.pixels.push_back({i / 14.0f, 1.0f - i / 14.0f, (i % 4) / 3.0f});
  writePng(folder / "a.png", image);
  const RgbImage read = readPng(folder / "a.png");
  ASSERT_EQ(read.size, image.size);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read.pixels[i][c], image.pixels[i][c], kHalfCode);
}

TEST(Png, ClampsWhatIsNoDisplayValue) {
  const test::TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  writePng(folder / "a.png", {{2, 1}, {{nan, infinity, -infinity}, {2.0f, -1.0f, 0.5f}}});
  const RgbImage read = readPng(folder / "a.png");
  EXPECT_EQ(read.at(0, 0), glm::vec3(0, 1, 0));
  EXPECT_EQ(read.at(1, 0), glm::vec3(1, 0, 128.0f / 255.0f));
}

TEST(WritePicture, TakesTheToneCurveForPngOnly) {
  const test::TemporaryFolder folder;
  const RgbImage radiance{{1, 1}, {{0.2f, 0.5f, 3.0f}}};
  writePicture(folder / "a.png", radiance, 1.0f);
  const glm::vec3 expected = displayFromRadiance(radiance.pixels[0], 1.0f);
  const glm::vec3 read = readPng(folder / "a.png").at(0, 0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(read[c], expected[c], kHalfCode);
}

TEST(CheckOutputPath, RefusesWhatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> png{".png"};
  checkOutputPath(folder / "a.png", "-o", png);
  checkOutputPath(folder / "A.PNG", "-o", png);
  checkOutputPath("a.png", "-o", png);
  EXPECT_THAT(refusalOf([&] { checkOutputPath(folder / "a.gif", "-o", png); }),
              AllOf(HasSubstr("a.gif"), HasSubstr(".png")));
  EXPECT_THAT(refusalOf([&] { checkOutputPath(folder / "a", "-o", png); }), HasSubstr("extension"));
  EXPECT_THAT(refusalOf([&] { checkOutputPath(folder / "no/a.png", "-o", png); }), HasSubstr("folder does not exist"));
  fs::create_directory(folder / "folder.png");
  EXPECT_THAT(refusalOf([&] { checkOutputPath(folder / "folder.png", "-o", png); }), HasSubstr("names a folder"));
  EXPECT_THAT(refusalOf([&] { checkOutputPath("", "-o", png); }), HasSubstr("-o: names no file"));
}

TEST(ReadPng, RefusesOtherFiles) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(refusalOf([&] { readPng(folder / "absent.png"); }), HasSubstr("no such file"));
  EXPECT_THAT(refusalOf([&] { readPng(folder.write("a.png", "no picture")); }), HasSubstr("not a readable png"));
}

} // namespace
} // namespace brickfield
