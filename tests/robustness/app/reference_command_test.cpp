// The reference's own flags: what is refused, what is written, what an interrupted run leaves.
#include "app/layers_io.h"
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

class ReferenceCommand : public CommandLine {
protected:
  static std::vector<std::string> command(std::vector<std::string> more) {
    std::vector<std::string> arguments{"reference", "scene.gltf", "-o", "kept.png", "--size", "16x8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  FrameLayers layersWith(std::vector<std::string> more) {
    more.insert(more.end(), {"--layers", "l.exr", "-o", "o.exr", "--size", "48x32"});
    more.insert(more.begin(), {"reference", "scene.gltf"});
    const ProgramResult result = runHere(more);
    EXPECT_EQ(result.exitCode, 0) << result.messages;
    return readLayers(folder_ / "l.exr");
  }
};

TEST_F(ReferenceCommand, RefusesWhatMakesNoSense) {
  for (const char* radius : {"0", "-1", "nan", "inf", "wide", ""})
    expectRefused(command({"--ao", "--ao-radius", radius}), {"--ao-radius"});
  expectRefused(command({"--ao-radius", "1"}), {"--ao-radius: needs --ao"});
  for (const char* what : {"", "bricks", "Field"}) expectRefused(command({"--sdf-as", what}), {"--sdf-as", "mesh"});
  expectRefused(command({"--shadows", "soft"}), {"--shadows", "soft"});
  for (const char* light : {"rectangle:0,1,0:0,0,0:1,1:5", "rectangle:0,1,0:0,-1,0:1:5",
                            "rectangle:0,1,0:0,-1,0:1,-1:5", "rectangle:0,1,0:0,-1,0:1,1"})
    expectRefused(command({"--light", light}), {"--light", light});
}

TEST_F(ReferenceCommand, WritesShadowsAndOcclusion) {
  const FrameLayers layers = layersWith({"--ao", "--ao-radius", "2", "--light", "sun:1,-1,0.3:5:3", "--light",
                                         "rectangle:0,4,0:0,-1,0:2,1:30", "--samples", "8"});
  const std::size_t pixels = 48 * 32;
  ASSERT_EQ(layers.shadow.size(), 2u);
  ASSERT_EQ(layers.ambientOcclusion.size(), pixels);
  int dimmed = 0, shadowed = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (layers.id[i] < 0) {
      EXPECT_EQ(layers.shadow[0][i], 1.0f);
      EXPECT_EQ(layers.ambientOcclusion[i], 1.0f);
    }
    dimmed += layers.ambientOcclusion[i] < 1.0f;
    shadowed += layers.shadow[0][i] < 1.0f;
  }
  EXPECT_GT(dimmed, 10);
  EXPECT_GT(shadowed, 10);
  const FrameLayers none = layersWith({"--shadows", "none"});
  EXPECT_TRUE(none.shadow.empty());
  EXPECT_TRUE(none.ambientOcclusion.empty());
}

TEST_F(ReferenceCommand, TracesFieldsOrTheTrianglesBehindThem) {
  fs::create_directory(folder_ / "cache");
  const std::vector<std::string> sdf{"--sdf", "Left", "--resolution", "24", "--cache", "cache", "--shadows", "none"};
  const FrameLayers mesh = layersWith({"--shadows", "none"});
  const FrameLayers field = layersWith(sdf);
  std::vector<std::string> asMesh = sdf;
  asMesh.insert(asMesh.end(), {"--sdf-as", "mesh"});
  const FrameLayers marked = layersWith(asMesh);
  EXPECT_EQ(marked.depth, mesh.depth) << "only marked";
  EXPECT_EQ(marked.kind, field.kind);
  EXPECT_NE(field.depth, mesh.depth) << "bricks of 8 bits are not triangles";
  // Boxes of 2 m, voxels of 1/12: depths along a slanted ray agree within a voxel but at edges.
  std::size_t sdfPixels = 0, apart = 0;
  for (std::size_t i = 0; i < mesh.depth.size(); ++i) {
    if (field.kind[i] != SurfaceKind::Sdf) continue;
    ++sdfPixels;
    apart += !(std::abs(field.depth[i] - mesh.depth[i]) < 1.0f / 12);
  }
  EXPECT_GT(sdfPixels, 50u);
  EXPECT_LT(apart, sdfPixels / 10);
}

TEST_F(ReferenceCommand, InterruptedLeavesNothing) {
  const std::vector<std::string> before = files();
  const ProgramResult result =
      runBrickfield({"reference", "scene.gltf", "-o", "kept.png", "--layers", "l.exr", "--ao", "--samples", "65536",
                     "--light", "sun:1,-1,0:9:3", "--light", "sphere:0,4,0:1:30", "--size", "1024x1024"},
                    folder_.path(), {1500, SIGINT, {}});
  EXPECT_EQ(result.exitCode, 128 + SIGINT) << result.messages;
  EXPECT_EQ(result.messages, "brickfield: cancelled\n");
  EXPECT_LT(result.seconds, 10.0);
  EXPECT_EQ(files(), before);
  EXPECT_EQ(readFile(folder_ / "kept.png").size(), 4u);
}

} // namespace
} // namespace brickfield::test
