// Walks stored samples, not points between them: reconstruction is not the baker's error.
#include "bakers/bake_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "bakers/mesh_distance.h"
#include "bakers/winding_number.h"

namespace brickfield {

namespace {

constexpr double kUnjudgedVoxels = 1e-3; // floats of object space place a sample no better
constexpr double kClampedShare = 0.999;  // of the range

/// What one sample says.
struct SampleError {
  float error = 0;    ///< magnitude
  float distance = 0; ///< unsigned, exact
  bool isOpen = false, isClamped = false, isWrongSide = false;
};

class Comparison {
public:
  explicit Comparison(const BakeInput& mesh) : soup_(gatherTriangles(mesh)), topology_(analyseTopology(soup_)) {
    std::vector<std::uint32_t> all, closed;
    for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t) {
      all.push_back(t);
      if (isClosed(t)) closed.push_back(t);
    }
    closedCount_ = closed.size();
    distances_.emplace(allTriangles_.emplace(soup_, std::move(all)));
    if (!closed.empty()) winding_.emplace(closedTriangles_.emplace(soup_, std::move(closed)));
  }

  BakeError summary() const {
    BakeError error;
    error.triangles = soup_.triangles.size();
    error.closedTriangles = closedCount_;
    error.openEdges = topology_.openEdges, error.nonManifoldEdges = topology_.nonManifoldEdges;
    return error;
  }

  SampleError at(glm::dvec3 pointObject, const BrickLevel& level, double stored) const {
    const glm::dvec3 point = soup_.soupFromObject(pointObject);
    const ClosestTriangle closest = distances_->closest(point);
    const double exact = closest.distance / (soup_.unitsPerMetre * level.voxelSizeObject);
    SampleError sample;
    sample.distance = static_cast<float>(exact);
    sample.isOpen = !isClosed(closest.triangle);
    sample.isClamped = std::abs(stored) >= kClampedShare * level.rangeVoxels;
    if (sample.isOpen) {
      sample.error = static_cast<float>(std::abs(std::abs(stored) - exact));
      return sample;
    }
    const double inside = std::abs(static_cast<double>(winding_->at(point))) >= 0.5 ? -exact : exact;
    sample.error = static_cast<float>(std::abs(stored - inside));
    sample.isWrongSide = exact > kUnjudgedVoxels && (stored < 0) != (inside < 0);
    return sample;
  }

private:
  bool isClosed(std::uint32_t triangle) const {
    return topology_.inClosedComponent[triangle] && !topology_.isFlatPair[triangle];
  }

  TriangleSoup soup_;
  MeshTopology topology_;
  std::size_t closedCount_ = 0;
  std::optional<MeshHierarchy> allTriangles_, closedTriangles_;
  std::optional<MeshDistance> distances_;
  std::optional<WindingNumber> winding_;
};

std::vector<SampleError> sampleErrors(const BrickField& field, const BrickLevel& level, const Comparison& comparison,
                                      std::uint64_t mostSamples) {
  std::vector<glm::ivec3> bricks; // in the order of their cells
  for (int z = 0; z < level.brickCounts.z; ++z)
    for (int y = 0; y < level.brickCounts.y; ++y)
      for (int x = 0; x < level.brickCounts.x; ++x)
        if (!IndirectionCell{level.indirection[level.cellIndex({x, y, z})]}.isEmpty()) bricks.emplace_back(x, y, z);
  const std::uint64_t all = std::uint64_t{bricks.size()} * kBrickSampleCount;
  const std::uint64_t stride = (all + mostSamples - 1) / mostSamples | 1; // odd: never stuck in one column
  std::vector<SampleError> samples((all + stride - 1) / stride);
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    const std::uint64_t number = i * stride;
    const glm::ivec3 brick = bricks[number / kBrickSampleCount];
    const int inBrick = static_cast<int>(number % kBrickSampleCount);
    const glm::ivec3 sample(inBrick % kBrickSamples, inBrick / kBrickSamples % kBrickSamples,
                            inBrick / (kBrickSamples * kBrickSamples));
    const IndirectionCell cell{level.indirection[level.cellIndex(brick)]};
    const glm::dvec3 point =
        glm::dvec3(field.originObject) + double{level.voxelSizeObject} * glm::dvec3(kBrickCells * brick + sample);
    samples[i] = comparison.at(point, level, storedDistance(level, cell.brickIndex(), sample));
  });
  return samples;
}

LevelError sumUp(const std::vector<SampleError>& samples) {
  LevelError result;
  std::vector<float> errors;
  double sum = 0, squares = 0, openSquares = 0;
  for (const SampleError& sample : samples) {
    const double error = sample.error;
    if (!sample.isOpen) {
      ++result.signedSamples;
      result.wrongSigns += sample.isWrongSide;
      if (sample.isWrongSide) result.farthestWrongSign = std::max(result.farthestWrongSign, double{sample.distance});
    }
    if (sample.isClamped) continue;
    if (sample.isOpen) {
      ++result.openSamples;
      openSquares += error * error;
      result.openMax = std::max(result.openMax, error);
    } else {
      errors.push_back(sample.error);
      sum += error, squares += error * error;
    }
  }
  if (result.openSamples) result.openRms = std::sqrt(openSquares / static_cast<double>(result.openSamples));
  result.samples = errors.size();
  if (errors.empty()) return result;
  const auto count = static_cast<double>(errors.size());
  result.mean = sum / count, result.rms = std::sqrt(squares / count);
  std::sort(errors.begin(), errors.end());
  result.p999 = errors[errors.size() - 1 - errors.size() / 1000];
  result.max = errors.back();
  return result;
}

} // namespace

BakeError measureBakeError(const BrickField& field, const BakeInput& mesh, std::uint64_t mostSamples) {
  const Comparison comparison(mesh);
  BakeError result = comparison.summary();
  for (const BrickLevel& level : field.levels)
    result.levels.push_back(sumUp(sampleErrors(field, level, comparison, mostSamples)));
  return result;
}

} // namespace brickfield
