// Scenes that an exact world field must take or refuse in one line, through the whole program.
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "app/image_io.h"

#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <typename Value>
void append(std::string& bytes, const std::vector<Value>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

class WorldFieldScenes : public CommandLine {
protected:
  /// One mesh of these triangles, three corners each. Key times and translations of its node, where they are given.
  void writeTriangles(const std::vector<float>& corners, const std::vector<float>& seconds = {},
                      const std::vector<float>& translations = {}, float scale = 1) {
    std::string bytes;
    append(bytes, corners);
    append(bytes, seconds);
    append(bytes, translations);
    std::vector<float> least(3, INFINITY), most(3, -INFINITY);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      least[i % 3] = std::min(least[i % 3], corners[i]);
      most[i % 3] = std::max(most[i % 3], corners[i]);
    }
    const std::size_t firstTime = corners.size() * 4, firstValue = firstTime + seconds.size() * 4;
    nlohmann::json scene = {{"asset", {{"version", "2.0"}}},
                            {"scene", 0},
                            {"scenes", {{{"nodes", {0}}}}},
                            {"nodes", {{{"mesh", 0}, {"name", "Only"}, {"scale", {scale, scale, scale}}}}},
                            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                            {"buffers", {{{"byteLength", bytes.size()}, {"uri", "made.bin"}}}},
                            {"bufferViews", {{{"buffer", 0}, {"byteLength", firstTime}}}},
                            {"accessors",
                             {{{"bufferView", 0},
                               {"componentType", 5126},
                               {"count", corners.size() / 3},
                               {"type", "VEC3"},
                               {"min", least},
                               {"max", most}}}}};
    if (!seconds.empty()) {
      scene["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", firstTime}, {"byteLength", seconds.size() * 4}});
      scene["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", firstValue}, {"byteLength", translations.size() * 4}});
      scene["accessors"].push_back({{"bufferView", 1},
                                    {"componentType", 5126},
                                    {"count", seconds.size()},
                                    {"type", "SCALAR"},
                                    {"min", {seconds.front()}},
                                    {"max", {seconds.back()}}});
      scene["accessors"].push_back(
          {{"bufferView", 2}, {"componentType", 5126}, {"count", translations.size() / 3}, {"type", "VEC3"}});
      scene["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                              {"samplers", {{{"input", 1}, {"output", 2}}}}}};
    }
    folder_.write("made.gltf", scene.dump());
    folder_.write("made.bin", bytes);
  }

  std::vector<std::string> drawing(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"render",         "made.gltf", "-o",      "made.png",      "--size",
                                       "32x32",          "--view",    "field",   "--world-field", "exact",
                                       "--field-texels", "64",        "--stats", "made.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /// Draws a cut of the field; returns how many different colours it shows.
  std::size_t drawnColors(const std::vector<std::string>& more = {}) {
    const ProgramResult result = runHere(drawing(more));
    EXPECT_EQ(result.exitCode, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
    if (result.exitCode != 0) return 0;
    const RgbImage picture = readPng("made.png");
    std::set<std::array<float, 3>> colors;
    for (const glm::vec3& pixel : picture.pixels) colors.insert({pixel.x, pixel.y, pixel.z});
    return colors.size();
  }
};

const std::vector<float> kTriangle{-1, 0, 0, 1, 0, 0, 0, 1, 0};

TEST_F(WorldFieldScenes, AnimationsWithoutNumbersAreRefused) {
  for (const std::vector<float>& values :
       {std::vector<float>{0, 0, 0, 0, kNan, 0}, std::vector<float>{0, 0, 0, INFINITY, 0, 0}}) {
    writeTriangles(kTriangle, {0, 1}, values);
    expectRefused(drawing({"--time", "0.5"}), {"made.gltf", "accessor 2"});
    expectRefused(drawing(), {"made.gltf", "accessor 2"});
    expectRefused({"bench", "world-field", "made.gltf"}, {"made.gltf", "accessor 2"});
  }
  writeTriangles(kTriangle, {0, kNan}, {0, 0, 0, 1, 0, 0});
  expectRefused(drawing({"--time", "0.5"}), {"made.gltf", "accessor 1"});
}

// Every number of the file is finite, what they make is not.
TEST_F(WorldFieldScenes, AnimationsThatOverflowAreRefused) {
  const float most = std::numeric_limits<float>::max();
  writeTriangles(kTriangle, {0, 1}, {-most, 0, 0, most, 0, 0}, 1e38f);
  expectRefused(drawing({"--time", "1"}), {"made.gltf", "finite"});
}

TEST_F(WorldFieldScenes, AnimationsThatAreFineAreDrawn) {
  writeTriangles(kTriangle, {0, 1}, {0, 0, 0, 1, 0, 0});
  EXPECT_GT(drawnColors({"--time", "0.5"}), 20u);
}

TEST_F(WorldFieldScenes, SizesBeyondTheReachOfShadersAreRefused) {
  writeTriangles(kTriangle);
  expectRefused({"render", "made.gltf", "-o", "made.png", "--size", "32x32", "--view", "field", "--field-texels", "512",
                 "--field-cascades", "4"},
                {"world field", "536870912 texels"});
}

TEST_F(WorldFieldScenes, WhatHasNoSurfaceHasNoErrors) {
  writeTriangles({0, 0, 0, 1, 0, 0, 2, 0, 0});
  expectRefused({"bench", "world-field", "made.gltf", "--show", "errors", "--sizes", "S", "--rays", "0"},
                {"made.gltf", "no surface"});
}

TEST_F(WorldFieldScenes, OneTriangleIsDrawnAtAnySize) {
  for (const float scale : {0.005f, 1.0f, 5000.0f}) {
    writeTriangles(kTriangle, {}, {}, scale);
    EXPECT_GT(drawnColors(), 20u) << scale;
  }
}

TEST_F(WorldFieldScenes, TrianglesWithoutAreaAreDrawn) {
  writeTriangles({0.5f, 0.25f, 0, 0.5f, 0.25f, 0, 0.5f, 0.25f, 0});
  drawnColors();
  writeTriangles({0, 0, 0, 1, 1, 1, 2, 2, 2});
  EXPECT_GT(drawnColors(), 5u) << "a line";
  std::vector<float> both = kTriangle;
  for (const float corner : {0.0f, 3.0f, 0.0f, 0.0f, 3.0f, 0.0f, 0.0f, 3.0f, 0.0f}) both.push_back(corner);
  writeTriangles(both);
  EXPECT_GT(drawnColors(), 20u) << "beside a whole one";
}

TEST_F(WorldFieldScenes, EmptyScenesAreDrawn) {
  folder_.write("made.gltf", R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
  EXPECT_GE(drawnColors(), 1u);
  EXPECT_LE(drawnColors(), 8u) << "far from anything, everywhere";
}

} // namespace
} // namespace brickfield::test
