// Walks stored samples, not points between them: reconstruction is not the baker's error.
#ifdef BRICKFIELD_BAKERS
#include "app/field_error.h"

#include <algorithm>

#include "bakers/mesh_distance.h"
#include "core/error.h"

namespace brickfield {

FieldError compareWithMesh(const BrickField& field, const BakeInput& mesh, std::uint64_t mostSamples) {
  const TriangleSoup soup = gatherTriangles(mesh);
  std::vector<std::uint32_t> triangles(soup.triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = static_cast<std::uint32_t>(i);
  const MeshHierarchy hierarchy(soup, std::move(triangles));
  const MeshDistance distances(hierarchy);
  const double voxelsPerSoupUnit = 1.0 / (soup.unitsPerMetre * field.levels.front().voxelSizeObject);

  const BrickLevel& level = field.levels.front();
  const std::uint64_t samples = std::uint64_t{level.brickCount()} * kBrickSampleCount;
  const std::uint64_t stride = std::max<std::uint64_t>(1, samples / mostSamples) | 1; // odd: never stuck in one column
  FieldError error;
  double sum = 0, sumSquares = 0;
  std::uint64_t number = 0; // of the sample, over all bricks in the order of their cells
  for (int z = 0; z < level.brickCounts.z; ++z)
    for (int y = 0; y < level.brickCounts.y; ++y)
      for (int x = 0; x < level.brickCounts.x; ++x) {
        const IndirectionCell cell{level.indirection[level.cellIndex({x, y, z})]};
        if (cell.isEmpty()) continue;
        for (int i = 0; i < kBrickSampleCount; ++i) {
          if (number++ % stride != 0) continue;
          const glm::ivec3 sample{i % kBrickSamples, i / kBrickSamples % kBrickSamples,
                                  i / (kBrickSamples * kBrickSamples)};
          const double stored = std::abs(storedDistance(level, cell.brickIndex(), sample));
          if (stored >= 0.999 * level.rangeVoxels) continue;
          const glm::dvec3 point =
              glm::dvec3(field.originObject) +
              double{level.voxelSizeObject} * glm::dvec3(kBrickCells * glm::ivec3(x, y, z) + sample);
          const double exact = distances.closest(soup.soupFromObject(point)).distance * voxelsPerSoupUnit;
          const double difference = std::abs(stored - exact);
          sum += difference;
          sumSquares += difference * difference;
          error.maxVoxels = std::max(error.maxVoxels, difference);
          ++error.samples;
        }
      }
  if (error.samples == 0) throw Failure("the field has no sample that is not clamped");
  error.meanVoxels = sum / static_cast<double>(error.samples);
  error.rmsVoxels = std::sqrt(sumSquares / static_cast<double>(error.samples));
  return error;
}

} // namespace brickfield
#endif
