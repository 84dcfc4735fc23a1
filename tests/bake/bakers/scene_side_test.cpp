// Floors and walls that are one flat double-sided mesh: their slabs lie away from the scene, whichever way they face,
// so that what lies just before them stays visible.
#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr float kDepthVoxels = 1.755f; // of slabs behind
constexpr float kFrontVoxels = 0.05f;  // as in bake_sheets_test.cpp
constexpr glm::vec3 kUp{0, 1, 0};

/// A floor of 6 m, a rug 3 mm above it, a box on the rug whose feet stand 3 mm below the floor, and a card that
/// stands in the middle of all, each a node of its own; all double-sided. The first faces down, as real ones do.
struct Room {
  Scene scene;
  enum { kFloor, kRug, kBox, kCard };

  explicit Room(bool floorFacesUp = false) {
    scene.materials.emplace_back().doubleSided = true;
    const float y = 0, w = 3;
    MeshCase floor, rug, box, card;
    if (floorFacesUp)
      floor.addQuad({-w, y, -w}, {-w, y, w}, {w, y, w}, {w, y, -w});
    else
      floor.addQuad({-w, y, -w}, {w, y, -w}, {w, y, w}, {-w, y, w});
    rug.addQuad({-1, 0.003f, -1}, {-1, 0.003f, 1}, {1, 0.003f, 1}, {1, 0.003f, -1});
    box.addBox({-0.5f, -0.003f, -0.5f}, {0.5f, 1, 0.5f});
    card.addQuad({-2, 0.1f, 0}, {-1.5f, 0.1f, 0}, {-1.5f, 0.6f, 0}, {-2, 0.6f, 0});
    scene.scenes.emplace_back();
    for (MeshCase* part : {&floor, &rug, &box, &card}) {
      scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()));
      Node& node = scene.nodes.emplace_back();
      node.mesh = static_cast<int>(scene.meshes.size());
      scene.meshes.push_back(part->scene.meshes[0]);
    }
  }

  BakeInput input(int node) const {
    const Pose pose = poseScene(scene, {});
    return bakeInputOf(scene, pose.instances.at(static_cast<std::size_t>(node)), pose);
  }
  BrickField bake(int node) const {
    BakeSettings settings;
    settings.resolution = 128;
    return bakeField(input(node), settings).field;
  }
};

/// Heights at which rays down and up meet the finest level.
glm::vec2 sidesAt(const BrickField& field, float x, float z) {
  const auto down = traceField(field, 0, {x, 10, z}, {0, -1, 0}, 0, 20);
  const auto up = traceField(field, 0, {x, -10, z}, {0, 1, 0}, 0, 20);
  EXPECT_TRUE(down && up);
  return {10 - down.value_or(99), up.value_or(99) - 10};
}

} // namespace

TEST(SceneSide, FloorsKeepTheirUpperSideWhicheverWayTheyFace) {
  for (const bool facesUp : {false, true}) {
    const Room room(facesUp);
    for (const int node : {Room::kFloor, Room::kRug}) {
      const float height = node == Room::kFloor ? 0 : 0.003f;
      EXPECT_EQ(room.input(node).seenFromObject, kUp);
      const BrickField field = room.bake(node);
      const float voxel = field.levels[0].voxelSizeObject;
      for (const float x : {-0.9f, -0.13f, 0.4f}) {
        const glm::vec2 sides = sidesAt(field, x, 0.7f * x);
        EXPECT_NEAR(sides.x, height, kFrontVoxels * voxel);
        EXPECT_NEAR(sides.y, height - kDepthVoxels * voxel, 0.1f * voxel);
      }
    }
    // The floor's voxel is 5 cm, sixteen times as much as the rug lies above it.
    EXPECT_LT(sidesAt(room.bake(Room::kFloor), 0.8f, 0.8f).x, sidesAt(room.bake(Room::kRug), 0.8f, 0.8f).x);
  }
}

TEST(SceneSide, OnlyFlatMeshesAtTheBorderHaveOne) {
  const Room room;
  EXPECT_EQ(room.input(Room::kBox).seenFromObject, glm::vec3(0));
  EXPECT_EQ(room.input(Room::kCard).seenFromObject, glm::vec3(0));
  Room bare;
  bare.scene.scenes[0].nodes = {Room::kFloor};
  EXPECT_EQ(bare.input(0).seenFromObject, glm::vec3(0)) << "alone it has no scene";
  Room single;
  single.scene.materials[0].doubleSided = false;
  EXPECT_EQ(single.input(Room::kFloor).seenFromObject, glm::vec3(0));
}

TEST(SceneSide, FollowsEveryTransform) {
  Room room;
  const glm::mat4 sheared(1, 0, 0, 0, 0.4f, 1.3f, 0.2f, 0, 0, 0.5f, 2, 0, 7, -3, 2, 1);
  const glm::mat4 mirrored = sheared * glm::mat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  for (const glm::mat4& matrix : {sheared, mirrored}) {
    for (Node& node : room.scene.nodes) node.matrix = matrix; // the whole room
    EXPECT_NEAR(glm::length(room.input(Room::kFloor).seenFromObject - kUp), 0, 1e-6f);
  }
  // The floor alone upside down: what is above it in the world is below it in its own space.
  room = Room();
  room.scene.nodes[Room::kFloor].rotation = {0, 1, 0, 0}; // half a turn about x
  EXPECT_NEAR(glm::length(room.input(Room::kFloor).seenFromObject + kUp), 0, 1e-6f);
  room.scene.nodes[Room::kFloor].rotation = {1, 0, 0, 0};
  room.scene.nodes[Room::kFloor].scale = {1, -1, 1};
  EXPECT_NEAR(glm::length(room.input(Room::kFloor).seenFromObject + kUp), 0, 1e-6f);
}

TEST(SceneSide, IsPartOfTheHash) {
  const Room room;
  BakeInput input = room.input(Room::kFloor);
  const Hash128 hash = bakeHash(input, {});
  input.seenFromObject = -input.seenFromObject;
  EXPECT_FALSE(bakeHash(input, {}) == hash);
}
