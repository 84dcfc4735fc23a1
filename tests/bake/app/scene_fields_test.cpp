// A whole scene's fields: shared ones once, the same on any number of threads and with any memory, from the cache the
// second time, and nothing half-done when it is cancelled.
#include "app/scene_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "field/bricks_file.h"
#include "tests/bake/bakers/mesh_cases.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using namespace test;

constexpr int kMeshes = 5;

/// Boxes of different sizes, each mesh shown by two nodes.
struct Boxes {
  Scene scene;
  Pose pose;

  Boxes() {
    scene.materials.emplace_back();
    SceneRoots roots;
    for (int i = 0; i < kMeshes; ++i) {
      MeshCase box;
      box.addBox(glm::vec3(-1), glm::vec3(1, 1, 0.2f + 0.15f * static_cast<float>(i)));
      scene.meshes.push_back(box.scene.meshes[0]);
      for (Primitive& primitive : scene.meshes.back().primitives)
        primitive.normals.assign(primitive.positions.size(), glm::vec3(0, 1, 0));
      for (int copy = 0; copy < 2; ++copy) {
        Node& node = scene.nodes.emplace_back();
        node.name = "Box" + std::to_string(i);
        node.mesh = i;
        node.translation = {3.0f * static_cast<float>(i), 3.0f * static_cast<float>(copy), 0};
        roots.nodes.push_back(static_cast<int>(scene.nodes.size()) - 1);
      }
    }
    scene.scenes.push_back(roots);
    pose = poseScene(scene, {});
  }

  std::vector<std::optional<BakeSettings>> settings(int threads, std::uint64_t memoryBytes = 0) const {
    BakeSettings each;
    each.resolution = 48;
    each.threads = threads, each.memoryBytes = memoryBytes;
    return std::vector<std::optional<BakeSettings>>(scene.nodes.size(), each);
  }
};

std::vector<std::vector<std::byte>> bytesOf(const SceneFieldsResult& result) {
  std::vector<std::vector<std::byte>> bytes;
  for (const BrickField& field : result.fields.fields) bytes.push_back(encodeBricks(field));
  return bytes;
}

TEST(SceneFields, SharedMeshesAreBakedOnceAndTheSameInAnyOrder) {
  const Boxes boxes;
  const SceneFieldsResult one = bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(1), {}, {});
  ASSERT_EQ(one.fields.fields.size(), static_cast<std::size_t>(kMeshes));
  EXPECT_EQ(one.baked, static_cast<std::size_t>(kMeshes));
  for (int i = 0; i < kMeshes; ++i) {
    EXPECT_EQ(one.fields.fieldOfNode[static_cast<std::size_t>(2 * i)], i);
    EXPECT_EQ(one.fields.fieldOfNode[static_cast<std::size_t>(2 * i + 1)], i);
  }
  const auto expected = bytesOf(one);
  EXPECT_NE(expected[0], expected[1]);
  // All threads; and so little memory that each is baked alone, though it suffices for each.
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{24} << 20}) {
    const SceneFieldsResult many = bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(0, memory), {}, {});
    EXPECT_EQ(bytesOf(many), expected);
    EXPECT_EQ(many.fields.fieldOfNode, one.fields.fieldOfNode);
  }
}

TEST(SceneFields, SecondTimeComesFromTheCache) {
  const Boxes boxes;
  const TemporaryFolder cache;
  const SceneFieldsResult first = bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(0), cache.path(), {});
  EXPECT_EQ(first.baked, static_cast<std::size_t>(kMeshes));
  const SceneFieldsResult second = bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(0), cache.path(), {});
  EXPECT_EQ(second.baked, 0u);
  EXPECT_EQ(bytesOf(second), bytesOf(first));
}

TEST(SceneFields, ProgressCountsFields) {
  const Boxes boxes;
  std::vector<std::uint64_t> counted;
  Progress progress;
  progress.report = [&](std::string_view stage, std::uint64_t done, std::uint64_t total) {
    EXPECT_EQ(stage, "bake 5 fields");
    EXPECT_EQ(total, 5u);
    counted.push_back(done);
  };
  bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(0), {}, progress);
  EXPECT_THAT(counted, ::testing::ElementsAre(1, 2, 3, 4, 5));
}

TEST(SceneFields, CancelledLeavesWholeEntriesOnly) {
  const Boxes boxes;
  const TemporaryFolder cache;
  std::atomic<bool> cancelled{false};
  Progress progress;
  progress.cancelled = &cancelled;
  progress.report = [&](std::string_view, std::uint64_t, std::uint64_t) { cancelled = true; };
  EXPECT_THROW(bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(1), cache.path(), progress), Cancelled);
  std::size_t entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(cache.path())) {
    ++entries;
    EXPECT_NO_THROW(readBricksFile(entry.path())) << entry.path();
  }
  EXPECT_EQ(entries, 1u) << "the one that was done";
}

TEST(SceneFields, MeshThatNeedsTooMuchIsNamed) {
  const Boxes boxes;
  try {
    bakeSceneFields(boxes.scene, boxes.pose, boxes.settings(0, std::uint64_t{2} << 20), {}, {});
    FAIL() << "baked";
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("node 0 \"Box0\": level 0: needs "));
  }
}

} // namespace
} // namespace brickfield
