// The number that a bake is refused with is what the process takes, and comes before it is taken.
#include "bakers/bake_memory.h"

#include <fstream>
#include <regex>

#include <malloc.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/bake/bakers/mesh_cases.h"

namespace brickfield {
namespace {

using namespace test;

/// A line of /proc/self/status, in bytes.
std::uint64_t statusBytes(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) return std::stoull(line.substr(key.size())) * 1024;
  return 0;
}
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCountsMore = true; // shadow memory
#else
constexpr bool kCountsMore = false;
#endif

/// Makes the peak what is held now, and that as little as can be.
void resetPeak() {
  ::malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

std::string refusal(const BakeInput& input, const BakeSettings& settings) {
  try {
    bakeField(input, settings);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

double mebibytesIn(const std::string& message) {
  std::smatch match;
  if (!std::regex_search(message, match, std::regex("needs ([0-9.]+) ([MG])iB"))) return -1;
  return std::stod(match[1]) * (match[2] == "G" ? 1024 : 1);
}

/// Mebibytes: what a bake says that it needs, and what the process takes for it.
struct BakeCost {
  double needed, taken;
};
BakeCost costOf(const BakeInput& input, BakeSettings settings) {
  settings.memoryBytes = 1 << 20;
  BakeCost cost{mebibytesIn(refusal(input, settings)), 0};
  settings.memoryBytes = 0;
  resetPeak();
  const std::uint64_t before = statusBytes("VmRSS:");
  bakeField(input, settings);
  cost.taken = static_cast<double>(statusBytes("VmHWM:") - before) / (1024 * 1024);
  fmt::print("{} triangles at {}: {:.0f} MiB needed, {:.0f} taken\n", input.primitives[0]->indices.size() / 3,
             settings.resolution, cost.needed, cost.taken);
  // What the process keeps of earlier bakes and takes again does not show: bounds from below are loose.
  EXPECT_LE(cost.taken, 1.05 * cost.needed + 16);
  return cost;
}

TEST(BakeMemory, RefusesWithTheNumberThatWouldDo) {
  MeshCase sphere;
  sphere.addSphere({0, 0, 0}, 1, 32, 64);
  BakeSettings settings;
  settings.resolution = 128;
  settings.memoryBytes = std::uint64_t{16} << 20;
  const std::string message = refusal(sphere.input("ball"), settings);
  EXPECT_THAT(message, ::testing::StartsWith("ball: level 0: needs "));
  EXPECT_THAT(message, ::testing::HasSubstr("more than 16 MiB"));
  EXPECT_EQ(message.find('\n'), std::string::npos);
  const double needed = mebibytesIn(message);
  ASSERT_GT(needed, 16);
  settings.memoryBytes = static_cast<std::uint64_t>((needed + 1) * 1024 * 1024);
  EXPECT_EQ(refusal(sphere.input("ball"), settings), "") << "the finest level needs most";
  settings.memoryBytes = static_cast<std::uint64_t>((needed - 2) * 1024 * 1024);
  EXPECT_NE(refusal(sphere.input("ball"), settings), "");
}

TEST(BakeMemory, NumberIsThatOfTheProcess) {
  if (kCountsMore) GTEST_SKIP() << "a sanitizer's memory counts too";
  MeshCase sphere;
  sphere.addSphere({0, 0, 0}, 1, 400, 800); // 640,000 triangles
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  for (const auto& [mesh, resolution] : {std::pair(&sphere, 64), std::pair(&box, 384), std::pair(&sphere, 256)}) {
    BakeSettings settings;
    settings.resolution = resolution;
    const BakeCost cost = costOf(mesh->input(), settings);
    EXPECT_GE(cost.taken, 0.25 * cost.needed - 16);
  }
}

// The faces are 4e-6 and 8e-6 voxels off the samples beside them.
TEST(BakeMemory, FacesAlongTheGridTakeNoMore) {
  if (kCountsMore) GTEST_SKIP() << "a sanitizer's memory counts too";
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  BakeSettings settings;
  settings.resolution = 384;
  settings.attributes = false;
  costOf(box.input(), settings);
}

TEST(BakeMemory, MostIsNeverExceeded) {
  // A cloud of small boxes reaches into every brick.
  MeshCase cloud;
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 10; ++x) cloud.addBox(glm::vec3(x, y, z), glm::vec3(x, y, z) + 0.5f);
  BakeSettings settings;
  settings.resolution = 64;
  settings.memoryBytes = 1 << 20;
  const double needed = mebibytesIn(refusal(cloud.input(), settings));
  const double most = static_cast<double>(mostBakeBytes(64, 12000)) / (1024 * 1024);
  EXPECT_GT(needed, 0.4 * most);
  EXPECT_LE(needed, most);
}

} // namespace
} // namespace brickfield
