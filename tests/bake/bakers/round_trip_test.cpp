// Bake, take the surface out, write and import it, bake again: the second field is the first one.
#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "field/brick_layout.h"
#include "field/iso_surface.h"
#include "scene/glb_export.h"
#include "tests/bake/bakers/mesh_cases.h"
#include "tests/support/manifold_check.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using namespace test;

/// The surface of a field's finest level as a scene that was read from a file.
Scene reimported(const IsoSurface& surface) {
  Primitive primitive;
  primitive.positions = surface.positions;
  primitive.normals = surface.normals;
  primitive.indices = surface.indices;
  const TemporaryFolder folder;
  writeFile(folder / "surface.glb", encodeGlb("surface", primitive, {}));
  return importGltf(folder / "surface.glb");
}

BakeInput onlyMesh(const Scene& scene) {
  PosedInstance instance;
  instance.node = 0;
  instance.mesh = 0;
  return bakeInputOf(scene, instance);
}

/// How far two fields are apart, in voxels of the finest level.
struct Difference {
  double rms = 0, p999 = 0, most = 0;
  std::size_t samples = 0;
};

/// Whether the surface passes between a sample and its neighbour in the brick along some axis.
bool isBesideSurface(const BrickLevel& level, std::uint32_t brick, glm::ivec3 sample) {
  const bool isInside = storedDistance(level, brick, sample) < 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      glm::ivec3 other = sample;
      other[axis] += step;
      if (other[axis] >= 0 && other[axis] < kBrickSamples && (storedDistance(level, brick, other) < 0) != isInside)
        return true;
    }
  return false;
}

/// At the samples beside the first field's surface. Deeper inside, the first one knows of triangles that the surface
/// hides.
Difference difference(const BrickField& first, const BrickField& second) {
  const BrickLevel& level = first.levels.front();
  std::vector<double> errors;
  for (int z = 0; z < level.brickCounts.z; ++z)
    for (int y = 0; y < level.brickCounts.y; ++y)
      for (int x = 0; x < level.brickCounts.x; ++x) {
        const IndirectionCell cell{level.indirection[level.cellIndex({x, y, z})]};
        if (cell.isEmpty()) continue;
        for (int i = 0; i < kBrickSampleCount; ++i) {
          const glm::ivec3 sample(i & 7, i >> 3 & 7, i >> 6);
          const glm::vec3 point = samplePointObject(first.originObject, level.voxelSizeObject, {x, y, z}, sample);
          if (!isBesideSurface(level, cell.brickIndex(), sample) || !second.boundsObject.contains(point)) continue;
          const double stored = storedDistance(level, cell.brickIndex(), sample);
          errors.push_back(std::abs(sampleDistance(second, 0, point) / level.voxelSizeObject - stored));
        }
      }
  Difference found;
  found.samples = errors.size();
  if (errors.empty()) return found;
  for (const double error : errors) found.rms += error * error;
  found.rms = std::sqrt(found.rms / static_cast<double>(errors.size()));
  std::sort(errors.begin(), errors.end());
  found.p999 = errors[errors.size() - 1 - errors.size() / 1000];
  found.most = errors.back();
  return found;
}

struct RoundTrip {
  IsoSurface surface;
  BakeResult first, second;
  Difference apart;
};

RoundTrip roundTrip(const BakeInput& input, int resolution) {
  RoundTrip trip;
  BakeSettings settings;
  settings.resolution = resolution;
  settings.bits = 16;
  trip.first = bakeField(input, settings);
  trip.surface = extractIsoSurface(trip.first.field, 0, 0);
  const Scene scene = reimported(trip.surface);
  trip.second = bakeField(onlyMesh(scene), settings);
  trip.apart = difference(trip.first.field, trip.second.field);
  return trip;
}

TEST(RoundTrip, SphereComesBack) {
  MeshCase ball;
  ball.addSphere({0.2f, 0.1f, -0.3f}, 0.5f, 64, 128);
  const RoundTrip trip = roundTrip(ball.input(), 48);
  const ManifoldCheck check = checkManifold(trip.surface.indices);
  EXPECT_TRUE(check.isClosedManifold());
  EXPECT_EQ(check.eulerCharacteristic(), 2);
  // Curvature k = 1/24 of a voxel: chords of up to sqrt(3) voxels lie k 3/8 = 0.016 inside, the trilinear surface up to
  // as much, and samples beside it inherit that.
  EXPECT_LT(trip.apart.most, 0.035) << trip.apart.rms;
  EXPECT_GT(trip.apart.samples, 10000u);
}

TEST(RoundTrip, RealMeshesComeBackClosed) {
  struct Case {
    const char* file;
    double rms;                          ///< voxels; measured, with half as much again
    std::optional<std::ptrdiff_t> euler; ///< where it is known: of a torus, of balls
  };
  const Case cases[] = {{"torus_5k.glb", 0.025, 0},
                        {"stanford_bunny_closed.glb", 0.04, 2},
                        {"blub_fish.glb", 0.04, 2},
                        {"suzanne.glb", 0.06, {}},
                        {"stanford_dragon_100k.glb", 0.14, {}}};
  for (const Case& mesh : cases) {
    SCOPED_TRACE(mesh.file);
    if (!requireData(mesh.file)) continue;
    const RoundTrip trip = roundTrip(FileCase(mesh.file).input(), 96);
    const ManifoldCheck check = checkManifold(trip.surface.indices);
    fmt::print("{}: {} triangles, Euler {}, apart: rms {:.4f}, 99.9 % {:.4f}, max {:.4f} voxels\n", mesh.file,
               check.triangles, check.eulerCharacteristic(), trip.apart.rms, trip.apart.p999, trip.apart.most);
    EXPECT_TRUE(check.isClosedManifold());
    if (mesh.euler) {
      EXPECT_EQ(check.eulerCharacteristic(), *mesh.euler);
      EXPECT_EQ(check.components, 1u);
    }
    EXPECT_LT(trip.apart.rms, mesh.rms);
    // At creases the samples' distances are those of what the cells cannot show; an interpolated one is off by the
    // weighted mean way to its corners at most.
    EXPECT_LT(trip.apart.most, 0.8661);
    EXPECT_EQ(trip.second.stats.openEdges, 0u);
    EXPECT_EQ(trip.second.stats.nonManifoldEdges, 0u);
    EXPECT_EQ(trip.second.stats.degenerateTriangles, 0u);
    EXPECT_EQ(trip.second.stats.sheetTriangles, 0u);
  }
}

} // namespace
} // namespace brickfield
