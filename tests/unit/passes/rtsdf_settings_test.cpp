// The paper's sizes and the ranges of its parameters.
#include "passes/world_field/rtsdf_settings.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include "core/error.h"

namespace brickfield {
namespace {

TEST(RtsdfSettings, SizesAreThoseOfTableTwo) {
  const struct {
    const char* name;
    int coarse, fine;
  } sizes[] = {{"S", 64, 128}, {"M", 128, 256}, {"L", 256, 512}};
  for (const auto& size : sizes) {
    RtsdfSettings settings;
    setRtsdfSize(settings, size.name);
    EXPECT_EQ(settings.coarseSize, size.coarse);
    EXPECT_EQ(settings.fineSize, size.fine);
    EXPECT_EQ(rtsdfExtent(settings), glm::ivec3(size.fine));
    EXPECT_FLOAT_EQ(rtsdfBeta(settings) / 2 * static_cast<float>(size.fine), 0.2f); // a tenth of a coarse texel
    EXPECT_NO_THROW(checkRtsdfSettings(settings));
  }
  RtsdfSettings settings;
  EXPECT_THROW(setRtsdfSize(settings, "XL"), BadInput);
  EXPECT_THROW(setRtsdfSize(settings, ""), BadInput);
}

TEST(RtsdfSettings, DefaultsAreThePapers) {
  const RtsdfSettings settings;
  EXPECT_EQ(settings.coarseSize, 128);
  EXPECT_EQ(settings.fineSize, 256);
  EXPECT_FLOAT_EQ(settings.decay, 0.95f);
  EXPECT_FLOAT_EQ(settings.maskWidth, 0.1f);
  EXPECT_FLOAT_EQ(settings.bias, 0.01f);
  EXPECT_EQ(settings.bruteExtent, glm::ivec3(400, 200, 400));
  EXPECT_FALSE(settings.bruteForce);
}

TEST(RtsdfSettings, BruteForceHasItsOwnExtent) {
  RtsdfSettings settings;
  settings.bruteForce = true;
  EXPECT_EQ(rtsdfExtent(settings), glm::ivec3(400, 200, 400));
  EXPECT_NO_THROW(checkRtsdfSettings(settings));
}

TEST(RtsdfSettings, BetaMayBeSet) {
  RtsdfSettings settings;
  settings.beta = 0.003f;
  EXPECT_FLOAT_EQ(rtsdfBeta(settings), 0.003f);
}

TEST(RtsdfSettings, ValuesOutOfRangeAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const struct {
    const char* named;
    std::function<void(RtsdfSettings&)> spoil;
  } cases[] = {
      {"coarse size", [](RtsdfSettings& s) { s.coarseSize = 100; }},
      {"coarse size", [](RtsdfSettings& s) { s.coarseSize = 4; }},
      {"coarse size", [](RtsdfSettings& s) { s.coarseSize = -128; }},
      {"fine size", [](RtsdfSettings& s) { s.fineSize = 1024; }},
      {"fine size", [](RtsdfSettings& s) { s.fineSize = 0; }},
      {"rays", [](RtsdfSettings& s) { s.raysPerTexel = -1; }},
      {"rays", [](RtsdfSettings& s) { s.raysPerTexel = 65; }},
      {"decay", [](RtsdfSettings& s) { s.decay = 1.01f; }},
      {"decay", [=](RtsdfSettings& s) { s.decay = nan; }},
      {"mask width", [](RtsdfSettings& s) { s.maskWidth = -0.1f; }},
      {"mask width", [=](RtsdfSettings& s) { s.maskWidth = nan; }},
      {"bias", [](RtsdfSettings& s) { s.bias = -0.01f; }},
      {"bias", [=](RtsdfSettings& s) { s.bias = infinity; }},
      {"beta", [](RtsdfSettings& s) { s.beta = -1.0f; }},
      {"beta", [=](RtsdfSettings& s) { s.beta = nan; }},
      {"brute force size", [](RtsdfSettings& s) { s.bruteExtent.y = 7; }},
      {"brute force size", [](RtsdfSettings& s) { s.bruteExtent.z = 513; }},
  };
  for (const auto& spoiled : cases) {
    RtsdfSettings settings;
    spoiled.spoil(settings);
    try {
      checkRtsdfSettings(settings);
      ADD_FAILURE() << spoiled.named << " was let pass";
    } catch (const BadInput& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(spoiled.named));
    }
  }
  RtsdfSettings wide;
  wide.maskWidth = infinity;
  EXPECT_NO_THROW(checkRtsdfSettings(wide));
}

} // namespace
} // namespace brickfield
