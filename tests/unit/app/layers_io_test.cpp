// Layers through a multi-part EXR and back, bit by bit.
#include "app/layers_io.h"

#include <chrono>
#include <fstream>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/exr.h"
#include "app/image_io.h"
#include "core/error.h"
#include "core/files.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

FrameLayers exampleLayers() {
  FrameLayers layers;
  layers.size = {3, 2};
  for (int i = 0; i < 6; ++i) {
    const float f = static_cast<float>(i);
    layers.color.push_back({f, 1e-6f * f, 1e6f * f});
    layers.depth.push_back(i == 2 ? kInfinity : 0.1f * f);
    layers.normal.push_back(glm::normalize(glm::vec3(f, 1, -1)));
    layers.normalSurface.push_back({0, -1, f});
    layers.albedo.push_back({0.1f, 0.2f, 0.3f * f});
    layers.id.push_back(i == 2 ? -1 : 16777210 + i);
    layers.kind.push_back(static_cast<SurfaceKind>(i % 3));
    layers.steps.push_back(f * 17);
    layers.ambientOcclusion.push_back(f / 8);
  }
  layers.shadow = {{0, 0.25f, 1, 0.5f, 0.75f, 1}, {1, 1, 1, 0, 0, 0.125f}};
  return layers;
}

void expectEqual(const FrameLayers& a, const FrameLayers& b) {
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.normalSurface, b.normalSurface);
  EXPECT_EQ(a.albedo, b.albedo);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.ambientOcclusion, b.ambientOcclusion);
  EXPECT_EQ(a.shadow, b.shadow);
}

std::string refusalOf(const std::filesystem::path& path) {
  try {
    readLayers(path);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LayersIo, RoundTripKeepsEveryValue) {
  const test::TemporaryFolder folder;
  writeLayers(folder / "all.exr", exampleLayers());
  expectEqual(readLayers(folder / "all.exr"), exampleLayers());
}

TEST(LayersIo, LayersThatAreNotMadeStayAbsent) {
  const test::TemporaryFolder folder;
  FrameLayers layers = exampleLayers();
  layers.color.clear();
  layers.steps.clear();
  layers.kind.clear();
  writeLayers(folder / "some.exr", layers);
  expectEqual(readLayers(folder / "some.exr"), layers);
  FrameLayers depthAlone;
  depthAlone.size = layers.size;
  depthAlone.depth = layers.depth;
  writeLayers(folder / "one.exr", depthAlone);
  expectEqual(readLayers(folder / "one.exr"), depthAlone);
}

TEST(LayersIo, PlainPictureIsTheColorLayer) {
  const test::TemporaryFolder folder;
  const FrameLayers layers = exampleLayers();
  writeExr(folder / "picture.exr", {layers.size, layers.color});
  FrameLayers expected;
  expected.size = layers.size;
  expected.color = layers.color;
  expectEqual(readLayers(folder / "picture.exr"), expected);
}

TEST(LayersIo, PartsAndChannelsHaveTheirPromisedNames) {
  const test::TemporaryFolder folder;
  writeLayers(folder / "all.exr", exampleLayers());
  std::vector<std::string> names;
  for (const ImagePart& part : readExrParts(folder / "all.exr")) {
    std::string name = part.name + ":";
    for (const std::string& channel : part.channels) name += channel;
    names.push_back(name);
  }
  EXPECT_THAT(names, ::testing::ElementsAre("color:RGB", "depth:Z", "normal:XYZ", "normal_surface:XYZ", "albedo:RGB",
                                            "id:ID", "kind:KIND", "ao:AO", "steps:STEPS", "shadow:V", "shadow_1:V"));
}

TEST(LayersIo, SameLayersGiveTheSameBytesAtAnyTime) {
  const test::TemporaryFolder folder;
  writeLayers(folder / "a.exr", exampleLayers());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // EXR writers like to note the second
  writeLayers(folder / "b.exr", exampleLayers());
  EXPECT_EQ(readFile(folder / "a.exr"), readFile(folder / "b.exr"));
}

TEST(LayersIo, RefusesFilesThatAreNone) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(refusalOf(folder / "absent.exr"), HasSubstr("no such file"));
  EXPECT_THAT(refusalOf(folder.path()), HasSubstr("not a regular file"));
  EXPECT_THAT(refusalOf(folder.write("text.exr", "no picture")),
              AllOf(HasSubstr("text.exr"), HasSubstr("not a readable")));
  writeExrParts(folder / "other.exr", {{"other", {1, 1}, {"V"}, {1.0f}}, {"more", {1, 1}, {"V"}, {1.0f}}});
  EXPECT_THAT(refusalOf(folder / "other.exr"), HasSubstr("no layer"));
}

TEST(LayersIo, RefusesTruncatedFilesAtEveryLength) {
  const test::TemporaryFolder folder;
  writeLayers(folder / "whole.exr", exampleLayers());
  const std::vector<std::byte> whole = readFile(folder / "whole.exr");
  for (std::size_t length = 0; length + 1 < whole.size(); length += 61) {
    writeFile(folder / "cut.exr", std::span(whole).first(length));
    EXPECT_THAT(refusalOf(folder / "cut.exr"), HasSubstr("cut.exr")) << length;
  }
}

TEST(LayersIo, RefusesLayersThatContradict) {
  const test::TemporaryFolder folder;
  const auto write = [&](std::vector<ImagePart> parts) {
    writeExrParts(folder / "bad.exr", parts);
    return refusalOf(folder / "bad.exr");
  };
  const ImagePart depth{"depth", {1, 1}, {"Z"}, {1.0f}};
  EXPECT_THAT(write({depth, {"kind", {1, 1}, {"KIND"}, {3.0f}}}), AllOf(HasSubstr("kind"), HasSubstr("whole number")));
  EXPECT_THAT(write({depth, {"id", {1, 1}, {"ID"}, {0.5f}}}), AllOf(HasSubstr("id"), HasSubstr("whole number")));
  EXPECT_THAT(write({depth, {"normal", {1, 1}, {"X", "Y"}, {1.0f, 1.0f}}}), HasSubstr("has no channel Z"));
}

TEST(LayersIo, RefusesToWriteLayersOfOtherLengths) {
  const test::TemporaryFolder folder;
  FrameLayers layers = exampleLayers();
  layers.depth.pop_back();
  EXPECT_THROW(writeLayers(folder / "bad.exr", layers), Failure);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.exr"));
  EXPECT_THROW(writeLayers(folder / "none.exr", {}), Failure);
}

} // namespace
} // namespace brickfield
