// What hangs together, what is closed, whatever order the triangles come in.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "scene/gltf_import.h"
#include "scene/surface_topology.h"
#include "tests/support/data.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/tube_mesh.h"

namespace brickfield::test {
namespace {

constexpr std::uint32_t kNone = SurfaceTopology::kNone;

// One primitive; corners by number, positions of the numbers.
Mesh meshOf(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices) {
  Mesh mesh;
  mesh.primitives.emplace_back();
  mesh.primitives[0].normals.assign(positions.size(), glm::vec3(0, 0, 1));
  mesh.primitives[0].positions = std::move(positions);
  mesh.primitives[0].indices = std::move(indices);
  return mesh;
}

const std::vector<glm::vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}};
// A tetrahedron of the first four, facing outwards.
const std::vector<std::uint32_t> kTetrahedron{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

std::vector<std::uint32_t> operator+(std::vector<std::uint32_t> a, const std::vector<std::uint32_t>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::size_t closedCount(const SurfaceTopology& topology) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < topology.triangleCount(); ++t) count += topology.isClosed(t) ? 1 : 0;
  return count;
}

// What must hold whatever the mesh is like.
void expectConsistent(const SurfaceTopology& topology) {
  for (std::uint32_t t = 0; t < topology.triangleCount(); ++t) {
    EXPECT_EQ(topology.isDegenerate[t], topology.componentOf[t] == kNone);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t beyond = topology.neighbours[t][k];
      EXPECT_FALSE(topology.isClosed(t) && beyond == kNone);
      if (beyond == kNone) continue;
      const auto& mine = topology.vertices[t];
      const auto& others = topology.vertices[beyond];
      // The neighbour names this triangle at an edge that runs back along the same vertices.
      bool isReturned = false;
      for (std::size_t j = 0; j < 3; ++j)
        isReturned = isReturned || (topology.neighbours[beyond][j] == t && others[j] == mine[(k + 1) % 3] &&
                                    others[(j + 1) % 3] == mine[k]);
      EXPECT_TRUE(isReturned) << t << " edge " << k;
      EXPECT_EQ(topology.componentOf[t], topology.componentOf[beyond]);
    }
  }
  ASSERT_EQ(topology.fanStarts.size(), topology.vertexCount + std::size_t{1});
  std::set<std::uint32_t> seen;
  for (std::uint32_t v = 0; v < topology.vertexCount; ++v)
    for (std::uint32_t i = topology.fanStarts[v]; i < topology.fanStarts[v + 1]; ++i) {
      const std::uint32_t corner = topology.fanCorners[i];
      EXPECT_EQ(topology.vertices[corner / 4][corner % 4], v);
      EXPECT_TRUE(seen.insert(corner).second);
    }
  std::size_t corners = 0;
  for (const bool isDegenerate : topology.isDegenerate) corners += isDegenerate ? 0 : 3;
  EXPECT_EQ(seen.size(), corners);
}

TEST(SurfaceTopologyTest, BoxIsClosedAndWeldsItsCorners) {
  const SurfaceTopology topology = analyseSurface(makeBoxMesh({1, 2, 3})); // 24 vertices, flat sides
  expectConsistent(topology);
  EXPECT_EQ(topology.triangleCount(), 12u);
  EXPECT_EQ(topology.vertexCount, 8u);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{true});
}

TEST(SurfaceTopologyTest, BoxWithoutALidIsOpen) {
  Mesh mesh = makeBoxMesh({1, 2, 3});
  mesh.primitives[0].indices.resize(30);
  const SurfaceTopology topology = analyseSurface(mesh);
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{false});
  EXPECT_EQ(topology.vertexCount, 8u);
  std::size_t open = 0;
  for (const auto& beyond : topology.neighbours)
    open += static_cast<std::size_t>(std::count(beyond.begin(), beyond.end(), kNone));
  EXPECT_EQ(open, 4u);
}

TEST(SurfaceTopologyTest, PartsOfAMeshAreJudgedAlone) {
  Mesh mesh = makeBoxMesh({1, 1, 1});
  mesh.primitives.push_back(makeBoxMesh({2, 2, 2}).primitives[0]);
  mesh.primitives[1].indices.resize(33);
  const SurfaceTopology topology = analyseSurface(mesh);
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, (std::vector<bool>{true, false}));
  EXPECT_EQ(closedCount(topology), 12u);
}

TEST(SurfaceTopologyTest, PrimitivesCloseEachOther) {
  Mesh mesh = makeBoxMesh({1, 1, 1});
  mesh.primitives.push_back(mesh.primitives[0]);
  mesh.primitives[0].indices.resize(15);
  mesh.primitives[1].indices.erase(mesh.primitives[1].indices.begin(), mesh.primitives[1].indices.begin() + 15);
  const SurfaceTopology topology = analyseSurface(mesh);
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{true});
}

TEST(SurfaceTopologyTest, DuplicatedVerticesAndNegativeZeroWeld) {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t index : kTetrahedron) {
    indices.push_back(static_cast<std::uint32_t>(positions.size()));
    positions.push_back(kCorners[index]);
    if (indices.size() % 2)
      for (int axis = 0; axis < 3; ++axis)
        if (positions.back()[axis] == 0) positions.back()[axis] = -0.0f;
  }
  const SurfaceTopology topology = analyseSurface(meshOf(positions, indices));
  expectConsistent(topology);
  EXPECT_EQ(topology.vertexCount, 4u);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{true});
}

TEST(SurfaceTopologyTest, FlippedTriangleOpensIt) {
  auto indices = kTetrahedron;
  std::swap(indices[0], indices[1]);
  const SurfaceTopology topology = analyseSurface(meshOf(kCorners, indices));
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{false}); // still one part
  EXPECT_EQ(topology.neighbours[0], (std::array<std::uint32_t, 3>{kNone, kNone, kNone}));
}

TEST(SurfaceTopologyTest, EdgeOfThreeTrianglesIsNobodysNeighbour) {
  const SurfaceTopology topology = analyseSurface(meshOf(kCorners, kTetrahedron + std::vector<std::uint32_t>{0, 1, 4}));
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{false});
  EXPECT_EQ(topology.neighbours[4], (std::array<std::uint32_t, 3>{kNone, kNone, kNone}));
  EXPECT_EQ(topology.neighbours[1][0], kNone); // the tetrahedron's own edge 0-1
  EXPECT_NE(topology.neighbours[1][1], kNone);
}

TEST(SurfaceTopologyTest, DegenerateTrianglesAreRowsAndNothingElse) {
  const SurfaceTopology topology = analyseSurface(
      meshOf(kCorners, std::vector<std::uint32_t>{0, 0, 1} + kTetrahedron + std::vector<std::uint32_t>{2, 3, 2}));
  expectConsistent(topology);
  EXPECT_EQ(topology.triangleCount(), 6u);
  EXPECT_TRUE(topology.isDegenerate.front() && topology.isDegenerate.back());
  EXPECT_EQ(closedCount(topology), 4u);
}

TEST(SurfaceTopologyTest, SolidsThatTouchInAPointHaveAVertexEach) {
  std::vector<glm::vec3> positions = kCorners;
  std::vector<std::uint32_t> indices = kTetrahedron;
  for (int i = 1; i < 4; ++i) positions.push_back(-kCorners[static_cast<std::size_t>(i)]);
  // The point reflection of the tetrahedron through corner 0 turns its faces, so they turn back.
  for (std::size_t i = 0; i < kTetrahedron.size(); i += 3)
    for (const std::size_t k : {0u, 2u, 1u}) indices.push_back(kTetrahedron[i + k] == 0 ? 0 : kTetrahedron[i + k] + 4);
  const SurfaceTopology topology = analyseSurface(meshOf(positions, indices));
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, (std::vector<bool>{true, true}));
  EXPECT_EQ(topology.vertexCount, 8u);
  EXPECT_NE(topology.vertices[0][0], topology.vertices[4][0]);
}

TEST(SurfaceTopologyTest, SidesWithoutRoomBetweenThemAreASheet) {
  // Two quads back to back with different diagonals: each edge has two uses, and the inside is empty.
  const std::vector<glm::vec3> quad{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const SurfaceTopology topology = analyseSurface(meshOf(quad, {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2}));
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{false});
}

TEST(SurfaceTopologyTest, CornersThatMoveApartStayApart) {
  Mesh mesh = meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 3, 4, 5});
  EXPECT_EQ(analyseSurface(mesh).vertexCount, 4u);

  Mesh skinned = mesh;
  skinned.primitives[0].influencesPerVertex = 4;
  for (int v = 0; v < 6; ++v) {
    // The same influences in another order are the same; what has no weight does not count.
    const bool isSecond = v >= 3;
    for (const int joint : isSecond ? std::array{2, 1, 7, 0} : std::array{1, 2, 0, 0})
      skinned.primitives[0].joints.push_back(static_cast<std::uint16_t>(joint));
    for (const float weight : isSecond ? std::array{0.25f, 0.75f, 0.0f, 0.0f} : std::array{0.75f, 0.25f, 0.0f, 0.0f})
      skinned.primitives[0].jointWeights.push_back(weight);
  }
  EXPECT_EQ(analyseSurface(skinned).vertexCount, 4u);
  skinned.primitives[0].joints[4 * 3] = 3;            // one of a pair hangs on another joint
  EXPECT_EQ(analyseSurface(skinned).vertexCount, 6u); // and with it the edge is gone
  expectConsistent(analyseSurface(skinned));

  Mesh morphed = mesh;
  morphed.primitives[0].morphTargets.resize(1);
  morphed.primitives[0].morphTargets[0].positions.assign(6, glm::vec3(0, 0, 1));
  EXPECT_EQ(analyseSurface(morphed).vertexCount, 4u);
  morphed.primitives[0].morphTargets[0].positions[5].z = 2;
  EXPECT_EQ(analyseSurface(morphed).vertexCount, 6u);
}

// Twelve corners around each end need ten caps, which face outwards: with them the tube has its volume.
TEST(SurfaceTopologyTest, EndsOfThinTubesAreClosed) {
  constexpr std::uint32_t kSides = 12;
  const Mesh mesh = makeTubeMesh(1, 60, kSides);
  const SurfaceTopology topology = analyseSurface(mesh);
  expectConsistent(topology);
  EXPECT_EQ(topology.isClosedComponent, std::vector<bool>{true});
  ASSERT_EQ(topology.caps.size(), 2u * (kSides - 2));
  EXPECT_EQ(topology.triangleCount(), 2u * kSides + topology.caps.size());
  const Primitive& primitive = mesh.primitives[0];
  double volume = 0;
  const auto add = [&](const std::uint32_t* v) {
    const auto& p = primitive.positions;
    volume += glm::dot(glm::dvec3(p[v[0]]), glm::cross(glm::dvec3(p[v[1]]), glm::dvec3(p[v[2]]))) / 6;
  };
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) add(&primitive.indices[i]);
  for (const SurfaceTopology::Cap& cap : topology.caps) add(cap.vertices.data());
  EXPECT_NEAR(volume, tubeVolume(1, 60, kSides), 1e-3);
}

/// Of revolution about z, open where the first and the last ring are.
Mesh makeBottle(const std::vector<glm::vec2>& rings, std::uint32_t sides, bool isInwards) {
  Mesh mesh;
  Primitive& primitive = mesh.primitives.emplace_back();
  for (const glm::vec2 ring : rings)
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double turn = 2 * std::numbers::pi * i / sides;
      primitive.positions.emplace_back(ring.x * std::cos(turn), ring.x * std::sin(turn), ring.y);
    }
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t i = 0; i < sides; ++i) {
      const std::uint32_t a = r * sides + i, b = r * sides + (i + 1) % sides, c = a + sides, d = b + sides;
      if (isInwards)
        primitive.indices.insert(primitive.indices.end(), {a, d, b, a, c, d});
      else
        primitive.indices.insert(primitive.indices.end(), {a, b, d, a, d, c});
    }
  return mesh;
}

// Their holes are a thousandth of their surface, but lamps and cameras may stand within.
TEST(SurfaceTopologyTest, RoomsWithWindowsStayOpen) {
  for (const bool isInwards : {false, true}) {
    const SurfaceTopology room =
        analyseSurface(makeBottle({{0.1f, -1}, {1, -0.9f}, {1, 0.9f}, {0.1f, 1}}, 16, isInwards));
    expectConsistent(room);
    EXPECT_TRUE(room.caps.empty());
    EXPECT_EQ(closedCount(room), 0u);
  }
  EXPECT_TRUE(analyseSurface(makeBottle({{1, -60}, {1, 60}}, 16, true)).caps.empty()); // a tunnel, from within
}

// Who asks for the mesh as it is gets it so.
TEST(SurfaceTopologyTest, HolesAreClosedOnlyOnRequest) {
  const Mesh mesh = makeTubeMesh(1, 60, 12);
  EXPECT_FALSE(analyseSurface(mesh).caps.empty());
  const SurfaceTopology open = analyseSurface(mesh, SmallHoles::Open);
  EXPECT_TRUE(open.caps.empty());
  EXPECT_EQ(closedCount(open), 0u);
}

TEST(SurfaceTopologyTest, OtherHolesStayOpen) {
  Mesh wide = makeTubeMesh(1, 20, 12);  // its ends are a fortieth of its surface
  Mesh split = makeTubeMesh(1, 60, 12); // corners of a cap would be deformed by two primitives
  split.primitives.push_back(split.primitives[0]);
  split.primitives[0].indices.resize(36);
  split.primitives[1].indices.erase(split.primitives[1].indices.begin(), split.primitives[1].indices.begin() + 36);
  Mesh flat = makeTubeMesh(1, 60, 12); // its ends are slits, which no triangles fill
  for (glm::vec3& position : flat.primitives[0].positions) position.y = 0;
  Mesh torn = makeTubeMesh(1, 60, 12); // not all else is fine
  std::swap(torn.primitives[0].indices[0], torn.primitives[0].indices[1]);
  for (const Mesh& mesh : {wide, split, flat, torn}) {
    const SurfaceTopology topology = analyseSurface(mesh);
    expectConsistent(topology);
    EXPECT_EQ(closedCount(topology), 0u);
    EXPECT_TRUE(topology.caps.empty());
  }
}

TEST(SurfaceTopologyTest, EmptyMeshHasNothing) {
  const SurfaceTopology topology = analyseSurface(Mesh{});
  expectConsistent(topology);
  EXPECT_EQ(topology.vertexCount, 0u);
}

TEST(SurfaceTopologyTest, RealMeshesAreWhatTheyAre) {
  struct File {
    const char* name;
    bool isClosed;
  };
  for (const File& file : {File{"torus_5k.glb", true}, File{"scorpion_100k.glb", true},
                           File{"stanford_bunny_closed.glb", true}, File{"two_sided_plane.glb", false}}) {
    if (!requireData(file.name)) continue;
    const Scene scene = importGltf(dataFile(file.name));
    const SurfaceTopology topology = analyseSurface(scene.meshes.at(0));
    expectConsistent(topology);
    std::size_t kept = 0;
    for (const bool isDegenerate : topology.isDegenerate) kept += isDegenerate ? 0 : 1;
    EXPECT_EQ(closedCount(topology), file.isClosed ? kept : 0u) << file.name;
  }
}

} // namespace
} // namespace brickfield::test
