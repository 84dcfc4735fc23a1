// Cell by cell, brick by brick, one layer beyond the grid included. Vertices are shared through their grid edges.
#include "field/iso_surface.h"

#include <span>
#include <unordered_map>

#include <fmt/format.h>

#include "core/error.h"
#include "field/brick_layout.h"
#include "field/cube_loops.h"
#include "field/level_lattice.h"

namespace brickfield {

namespace {

// Nearer to a grid point, vertices of several edges would be one point of floats. Half a step of the 8-bit code is
// four times as much.
constexpr double kLeastFromGridPoint = 1.0 / 256.0;

glm::dvec3 cornerOf(std::size_t corner) {
  return {static_cast<double>(corner & 1), static_cast<double>(corner >> 1 & 1), static_cast<double>(corner >> 2)};
}

/// The middle of a loop, moved along the gradient to where the cell's trilinear field is zero, but not out of the cell.
glm::dvec3 onSurface(const VoxelCorners& corners, glm::dvec3 point) {
  constexpr int kSteps = 4; // Newton's; from the middle of a loop the second is within 1e-3 voxel already
  constexpr double kStep = 1.0 / 64.0, kLongestMove = 0.5;
  for (int i = 0; i < kSteps; ++i) {
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 offset(0.0);
      offset[axis] = kStep;
      gradient[axis] = (trilinear(corners, point + offset) - trilinear(corners, point - offset)) / (2 * kStep);
    }
    const double steepness = glm::dot(gradient, gradient);
    if (!(steepness > 1e-6)) break;
    glm::dvec3 move = -trilinear(corners, point) / steepness * gradient;
    if (const double length = glm::length(move); length > kLongestMove) move *= kLongestMove / length;
    point = glm::clamp(point + move, kLeastFromGridPoint, 1 - kLeastFromGridPoint);
  }
  return point;
}

class Extraction {
public:
  Extraction(const BrickField& field, std::size_t level, double isoVoxels)
      : field_(field), level_(level), bricks_(field.levels[level]), lattice_(bricks_), isoVoxels_(isoVoxels) {}

  void addBrick(glm::ivec3 brick) {
    if (!lattice_.mayChangeSign(brick)) return;
    const std::array<double, kBrickSampleCount> values = lattice_.ofBrick(brick);
    for (int z = 0; z < kBrickCells; ++z)
      for (int y = 0; y < kBrickCells; ++y)
        for (int x = 0; x < kBrickCells; ++x) {
          VoxelCorners corners;
          int insideCount = 0;
          for (int i = 0; i < 8; ++i) {
            const double value = values[sampleIndex({x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)})] - isoVoxels_;
            corners[static_cast<std::size_t>(i)] = value;
            insideCount += isInsideValue(value);
          }
          if (insideCount > 0 && insideCount < 8) addCell(kBrickCells * brick + glm::ivec3(x, y, z), corners);
        }
  }

  IsoSurface take() { return std::move(surface_); }

private:
  void addCell(glm::ivec3 cell, const VoxelCorners& corners) {
    const CubeLoops loops = findCubeLoops(corners);
    std::size_t begin = 0;
    for (std::size_t loop = 0; loop < loops.count; ++loop) {
      const std::size_t length = loops.lengths[loop];
      std::array<std::uint32_t, kCubeEdges> vertices;
      for (std::size_t i = 0; i < length; ++i) vertices[i] = vertexOn(cell, loops.edges[begin + i], corners);
      begin += length;
      fill(std::span(vertices).first(length), cell, corners);
    }
  }

  /// Diagonals of longer loops than four could run along a face, where the next cell may have the same one.
  void fill(std::span<const std::uint32_t> loop, glm::ivec3 cell, const VoxelCorners& corners) {
    if (loop.size() <= 4) {
      addTriangle(loop[0], loop[1], loop[2]);
      if (loop.size() == 4) addTriangle(loop[0], loop[2], loop[3]);
      return;
    }
    glm::dvec3 middle(0.0);
    for (const std::uint32_t vertex : loop) middle += voxelsOfVertex_[vertex] - glm::dvec3(cell);
    const std::uint32_t center =
        addVertex(glm::dvec3(cell) + onSurface(corners, middle / static_cast<double>(loop.size())));
    for (std::size_t i = 0; i < loop.size(); ++i) addTriangle(loop[i], loop[(i + 1) % loop.size()], center);
  }

  std::uint32_t vertexOn(glm::ivec3 cell, std::uint8_t edge, const VoxelCorners& corners) {
    const auto [low, high] = cornersOfEdge(edge);
    const glm::ivec3 point = cell + glm::ivec3(cornerOf(low));
    // 14 bits hold the 7,168 points of 1,024 bricks and a layer on each side.
    const auto part = [](int value) { return static_cast<std::uint64_t>(value + kBrickCells); };
    const std::uint64_t key = ((part(point.x) << 14 | part(point.y)) << 14 | part(point.z)) << 2 | edge / 4;
    const auto [entry, isNew] = vertexOfEdge_.try_emplace(key, 0);
    if (isNew) {
      const double along =
          std::clamp(corners[low] / (corners[low] - corners[high]), kLeastFromGridPoint, 1 - kLeastFromGridPoint);
      entry->second = addVertex(glm::dvec3(cell) + glm::mix(cornerOf(low), cornerOf(high), along));
    }
    return entry->second;
  }

  std::uint32_t addVertex(glm::dvec3 pointVoxels) {
    const glm::dvec3 pointObject = glm::dvec3(field_.originObject) + double{bricks_.voxelSizeObject} * pointVoxels;
    voxelsOfVertex_.push_back(pointVoxels);
    surface_.positions.emplace_back(pointObject);
    surface_.normals.push_back(fieldNormal(field_, level_, glm::vec3(pointObject)));
    return static_cast<std::uint32_t>(surface_.positions.size() - 1);
  }

  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    surface_.indices.insert(surface_.indices.end(), {a, b, c});
  }

  const BrickField& field_;
  std::size_t level_;
  const BrickLevel& bricks_;
  LevelLattice lattice_;
  double isoVoxels_;
  IsoSurface surface_;
  std::vector<glm::dvec3> voxelsOfVertex_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertexOfEdge_; ///< by the edge's lower grid point and its axis
};

} // namespace

IsoSurface extractIsoSurface(const BrickField& field, std::size_t level, double isoMetres, const Progress& progress) {
  if (level >= field.levels.size())
    throw BadInput("level", fmt::format("{}", level), fmt::format("the field has {}, from 0", field.levels.size()));
  const BrickLevel& bricks = field.levels[level];
  const double isoVoxels = isoMetres / bricks.voxelSizeObject;
  if (!(std::abs(isoVoxels) <= kMostIsoVoxels))
    throw BadInput("iso", fmt::format("{:g}", isoMetres),
                   fmt::format("is {:.3g} voxels of level {}; at most {} are stored around its surface, {:.4g} metres",
                               isoVoxels, level, kMostIsoVoxels, kMostIsoVoxels * bricks.voxelSizeObject));
  Extraction extraction(field, level, isoVoxels);
  const auto layers = static_cast<std::uint64_t>(bricks.brickCounts.z) + 2;
  for (int z = -1; z <= bricks.brickCounts.z; ++z) {
    if (progress.isCancelled()) throw Cancelled();
    for (int y = -1; y <= bricks.brickCounts.y; ++y)
      for (int x = -1; x <= bricks.brickCounts.x; ++x) extraction.addBrick({x, y, z});
    if (progress.report) progress.report("mesh", static_cast<std::uint64_t>(z + 2), layers);
  }
  return extraction.take();
}

} // namespace brickfield
