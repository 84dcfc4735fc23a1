// The scenes that brickfield_scenes writes, judged from outside: the program is run and its files are imported.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "core/files.h"
#include "scene/gltf_import.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

/// Exit code of the program.
int runScenes(const std::string& arguments) {
  std::string command = "'" BRICKFIELD_BINARY_DIR "/brickfield_scenes' " + arguments + " 2>/dev/null";
  int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Scene importedScene(const test::TemporaryFolder& folder, const std::string& arguments) {
  std::filesystem::path file = folder / "scene.glb";
  EXPECT_EQ(runScenes(arguments + " -o '" + file.string() + "'"), 0);
  return importGltf(file);
}

const Mesh* meshNamed(const Scene& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name == name) return &mesh;
  }
  return nullptr;
}

using Point = std::tuple<float, float, float>;
Point pointOf(glm::vec3 p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

/// Directed edges that are not matched by exactly one in the other direction, where equal positions count as one.
int unmatchedEdges(const Primitive& primitive) {
  std::map<std::pair<Point, Point>, int> edges;
  for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
    std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    ++edges[{pointOf(primitive.positions[primitive.indices[i]]),
             pointOf(primitive.positions[primitive.indices[next]])}];
  }
  int unmatched = 0;
  for (const auto& [edge, count] : edges) {
    auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) ++unmatched;
  }
  return unmatched;
}

/// The demo, written once for all tests: it takes seconds.
const std::filesystem::path& demoFile() {
  static test::TemporaryFolder folder;
  static const std::filesystem::path file = [] {
    std::filesystem::path path = folder / "demo.glb";
    EXPECT_EQ(runScenes("demo -o '" + path.string() + "'"), 0);
    return path;
  }();
  return file;
}

TEST(DemoScenes, DemoIsSmallAndTheSameEveryTime) {
  test::TemporaryFolder folder;
  ASSERT_EQ(runScenes("demo -o '" + (folder / "again.glb").string() + "'"), 0);
  std::vector<std::byte> first = readFile(demoFile());
  EXPECT_LT(first.size(), std::size_t{8} << 20);
  EXPECT_EQ(first, readFile(folder / "again.glb"));
}

TEST(DemoScenes, EverySdfMeshOfTheDemoIsClosed) {
  Scene scene = importGltf(demoFile());
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
  int sdfCount = 0;
  for (const Node& node : scene.nodes) {
    if (!node.sdf.sdf) continue;
    ++sdfCount;
    for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      EXPECT_EQ(unmatchedEdges(primitive), 0) << node.name;
    }
  }
  EXPECT_GE(sdfCount, 9);
}

/// Largest angle in degrees between neighbouring triangles whose corners all lie in these rows of the texture.
float largestFoldDegrees(const Primitive& primitive, float rowFrom, float rowTo) {
  std::map<std::pair<Point, Point>, glm::vec3> normalLeftOf;
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    std::array<glm::vec3, 3> corners;
    bool isInside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t vertex = primitive.indices[i + k];
      corners[k] = primitive.positions[vertex];
      isInside = isInside && primitive.uvs[0][vertex].y >= rowFrom && primitive.uvs[0][vertex].y <= rowTo;
    }
    if (!isInside) continue;
    glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (std::size_t k = 0; k < 3; ++k) normalLeftOf[{pointOf(corners[k]), pointOf(corners[(k + 1) % 3])}] = normal;
  }
  float largest = 0;
  for (const auto& [edge, normal] : normalLeftOf) {
    auto other = normalLeftOf.find({edge.second, edge.first});
    if (other == normalLeftOf.end()) continue;
    float cosine = std::min(glm::dot(normal, other->second), 1.0f);
    largest = std::max(largest, glm::degrees(std::acos(cosine)));
  }
  return largest;
}

TEST(DemoScenes, TeapotHasThePublishedExtentAndNoFoldBetweenPatches) {
  Scene scene = importGltf(demoFile());
  const Mesh* mesh = meshNamed(scene, "Teapot");
  ASSERT_NE(mesh, nullptr);
  const Primitive& teapot = mesh->primitives.at(0);
  Box box;
  for (glm::vec3 position : teapot.positions) box.extend(position);
  // Newell's data: handle to x = -3, belly of radius 2, knob at 3.15.
  EXPECT_FLOAT_EQ(box.min.x, -3.0f);
  EXPECT_FLOAT_EQ(box.min.y, 0.0f);
  EXPECT_FLOAT_EQ(box.max.y, 3.15f);
  EXPECT_FLOAT_EQ(box.max.z, 2.0f);
  EXPECT_NEAR(box.max.x, 3.434f, 0.001f);
  // Eight patches of the body (rows 0.26 to 0.68) with 14 cells a side turn by 90°/14 = 6.4° a cell around, and 8.8° a
  // cell where the profile bends most, at the foot. A fold between patches would stand out from that.
  EXPECT_LT(largestFoldDegrees(teapot, 0.2601f, 0.6799f), 10.0f);
  EXPECT_GT(largestFoldDegrees(teapot, 0.2601f, 0.6799f), 5.0f);
}

TEST(DemoScenes, StressPlacesAsManyInstancesAsAsked) {
  test::TemporaryFolder folder;
  Scene scene = importedScene(folder, "stress --count 101 --seed 7");
  std::size_t placed = 0;
  for (const Node& node : scene.nodes) placed += node.nodeFromInstance.size();
  EXPECT_EQ(placed, 101u);
  Scene other = importedScene(folder, "stress --count 101 --seed 8");
  EXPECT_NE(scene.nodes[0].nodeFromInstance[0][3], other.nodes[0].nodeFromInstance[0][3]);
  for (const Mesh& mesh : scene.meshes) EXPECT_EQ(unmatchedEdges(mesh.primitives[0]), 0) << mesh.name;
}

TEST(DemoScenes, InterpenetrationHasTwoOfEachKind) {
  test::TemporaryFolder folder;
  Scene scene = importedScene(folder, "interpenetration");
  int meshes = 0, sdfs = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    ++(node.sdf.sdf ? sdfs : meshes);
    EXPECT_EQ(unmatchedEdges(scene.meshes[static_cast<std::size_t>(node.mesh)].primitives[0]), 0) << node.name;
  }
  EXPECT_EQ(meshes, 2);
  EXPECT_EQ(sdfs, 2);
}

// Where the thesis has them; every object is closed, and the hall is made of meshes.
TEST(DemoScenes, ThesisHasItsHallAndAsManyObjectsAsAsked) {
  test::TemporaryFolder folder;
  for (const int count : {15, 100}) {
    Scene scene = importedScene(folder, "thesis --count " + std::to_string(count));
    int objects = 0, meshes = 0;
    glm::vec3 last(0);
    for (const Node& node : scene.nodes) {
      if (node.mesh < 0) continue;
      ++(node.sdf.sdf ? objects : meshes);
      if (node.name == "Figure") last = node.translation;
    }
    EXPECT_EQ(objects, count);
    EXPECT_EQ(meshes, 6 + 8);
    EXPECT_EQ(last, count == 15 ? glm::vec3(-10, 2.8f, -4) : glm::vec3(-15, 14.8f, -24));
    for (const Mesh& mesh : scene.meshes) EXPECT_EQ(unmatchedEdges(mesh.primitives[0]), 0) << mesh.name;
    EXPECT_EQ(scene.lights.at(0).radius, 0.5f);
  }
}

TEST(DemoScenes, WrongUsageExitsWithTwo) {
  test::TemporaryFolder folder;
  std::string output = " -o '" + (folder / "x.glb").string() + "'";
  for (const char* arguments : {"", "demo", "demo -o", "demo -o x.png", "interpenetration -o /no-such-folder/x.glb"}) {
    EXPECT_EQ(runScenes(arguments), 2) << arguments;
  }
  for (const char* arguments : {"chess", "demo --count 3", "stress --count 0", "stress --count 1e3", "stress --seed -1",
                                "thesis --count 2", "thesis --count 101", "thesis --seed 1"}) {
    EXPECT_EQ(runScenes(arguments + output), 2) << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x.glb"));
}

} // namespace
} // namespace brickfield
