// Signs and distances of every closed mesh in the data folder, against brute force; the test prints which it covered.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "bakers/band_accuracy.h"
#include "bakers/mesh_topology.h"
#include "core/error.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr double kMostError = 1e-5; // voxels, before coding
constexpr double kBruteWork = 1e6;  // samples times triangles, a mesh

/// What the closed meshes of a file came to.
struct FileTally {
  std::size_t closed = 0, different = 0, nonManifold = 0, samples = 0, wrongSigns = 0;
  double largestError = 0;
};

std::vector<std::filesystem::path> meshFiles() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(dataFolder()))
    if (entry.path().extension() == ".glb") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Nothing where no triangle has an area.
std::optional<TriangleSoup> soupOf(const BakeInput& input) {
  try {
    return gatherTriangles(input);
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

FileTally tallyFile(const std::filesystem::path& path) {
  const Scene scene = importGltf(path);
  FileTally tally;
  std::set<std::array<double, 4>> seen; // triangles, and where the last vertex is
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    PosedInstance instance;
    instance.node = 0;
    instance.mesh = static_cast<int>(m);
    instance.morphWeights = scene.meshes[m].morphWeights;
    const BakeInput input = bakeInputOf(scene, instance);
    const std::optional<TriangleSoup> soup = soupOf(input);
    if (!soup) continue;
    const MeshTopology topology = analyseTopology(*soup);
    if (!topology.isClosed()) continue;
    ++tally.closed;
    // Copies of one mesh under several materials are baked once.
    const glm::dvec3 last = soup->centerObject + soup->positions.back() / soup->unitsPerMetre;
    if (!seen.insert({static_cast<double>(soup->triangles.size()), last.x, last.y, last.z}).second) continue;
    ++tally.different;
    tally.nonManifold += topology.nonManifoldEdges > 0;
    BakeSettings settings;
    settings.resolution = 48;
    settings.sign = SignMethod::Winding;
    const BandBake band = bakeBand(input, settings);
    const double affordable = kBruteWork / static_cast<double>(band.stats.triangles);
    const BandAccuracy accuracy = measureBand(band, static_cast<std::size_t>(std::clamp(affordable, 60.0, 2000.0)));
    tally.samples += accuracy.samples;
    tally.wrongSigns += accuracy.wrongSigns;
    tally.largestError = std::max(tally.largestError, accuracy.largestError);
  }
  return tally;
}

} // namespace

TEST(ClosedMeshes, OfAllDataHaveNoWrongSign) {
  if (!hasData()) return reportNotRun("no data folder");
  FileTally all;
  for (const std::filesystem::path& path : meshFiles()) {
    SCOPED_TRACE(path.filename());
    const FileTally tally = tallyFile(path);
    EXPECT_EQ(tally.wrongSigns, 0u);
    EXPECT_LE(tally.largestError, kMostError);
    if (tally.closed > 0)
      std::printf("%s: %zu closed, %zu of them different\n", path.filename().c_str(), tally.closed, tally.different);
    all.closed += tally.closed, all.different += tally.different, all.nonManifold += tally.nonManifold;
    all.samples += tally.samples;
  }
  std::printf("all: %zu closed meshes, %zu different, %zu of those with non-manifold edges; %zu samples\n", all.closed,
              all.different, all.nonManifold, all.samples);
  EXPECT_GE(all.closed, 150u); // of a data folder that holds all that its README lists
  EXPECT_GE(all.nonManifold, 2u);
}
