// The scenes that brickfield_scenes writes, judged from outside: the program is run and its files are imported.
#include <sys/wait.h>

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

TEST(DemoScenes, TeapotHasThePublishedExtentAndNoCreaseBetweenQuarters) {
  Scene scene = importGltf(demoFile());
  const Mesh* mesh = meshNamed(scene, "Teapot");
  ASSERT_NE(mesh, nullptr);
  const Primitive& teapot = mesh->primitives.at(0);
  Box box;
  // The body's two rows of patches by their rows of the texture, borders and what touches them left out.
  std::map<Point, std::vector<glm::vec3>> bodyNormals;
  for (std::size_t i = 0; i < teapot.positions.size(); ++i) {
    box.extend(teapot.positions[i]);
    float row = teapot.uvs[0][i].y;
    if (row > 0.265f && row < 0.675f) bodyNormals[pointOf(teapot.positions[i])].push_back(teapot.normals[i]);
  }
  // Newell's data: handle to x = -3, belly of radius 2, knob at 3.15.
  EXPECT_FLOAT_EQ(box.min.x, -3.0f);
  EXPECT_FLOAT_EQ(box.min.y, 0.0f);
  EXPECT_FLOAT_EQ(box.max.y, 3.15f);
  EXPECT_FLOAT_EQ(box.max.z, 2.0f);
  EXPECT_NEAR(box.max.x, 3.434f, 0.001f);
  int seamPoints = 0;
  for (const auto& [point, normals] : bodyNormals) {
    if (normals.size() > 1) ++seamPoints;
    for (glm::vec3 normal : normals) EXPECT_GT(glm::dot(normal, normals.front()), 0.9999f);
  }
  // Four seams between quarters, and the ring between the two rows, each with a patch's worth of points.
  EXPECT_GT(seamPoints, 4 * 14);
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

TEST(DemoScenes, WrongUsageExitsWithTwo) {
  test::TemporaryFolder folder;
  std::string output = " -o '" + (folder / "x.glb").string() + "'";
  for (const char* arguments : {"", "demo", "demo -o", "demo -o x.png", "interpenetration -o /no-such-folder/x.glb"}) {
    EXPECT_EQ(runScenes(arguments), 2) << arguments;
  }
  for (const char* arguments :
       {"chess", "demo --count 3", "stress --count 0", "stress --count 1e3", "stress --seed -1"}) {
    EXPECT_EQ(runScenes(arguments + output), 2) << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x.glb"));
}

} // namespace
} // namespace brickfield
