// Boxes in, lists out.
#include "passes/world_field/world_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "passes/world_field/nearest_points.h"

namespace brickfield {

namespace {

// Cascades are anchored anew when the eye is this many sides of the coarsest window away.
constexpr double kAnchorSides = 4;

glm::vec3 anchoredOf(const shared::SdfInstance& row, glm::dvec3 pointGrid, glm::dvec3 anchorWorld) {
  glm::dvec3 world;
  for (int axis = 0; axis < 3; ++axis)
    world[axis] = glm::dot(glm::dvec4(row.worldFromGrid[axis]), glm::dvec4(pointGrid, 1.0));
  return glm::vec3(world - anchorWorld);
}

glm::dvec3 cornerOf(const shared::SdfInstance& row, int corner) {
  glm::dvec3 grid;
  for (int axis = 0; axis < 3; ++axis) grid[axis] = corner >> axis & 1 ? row.boxMax[axis] : row.boxMin[axis];
  return grid;
}

Box boxOf(const shared::SdfInstance& row, glm::dvec3 anchorWorld) {
  Box box;
  for (int corner = 0; corner < 8; ++corner) box.extend(anchoredOf(row, cornerOf(row, corner), anchorWorld));
  return box;
}

/// Around the object's box; a little larger, because the GPU rounds otherwise.
glm::vec4 sphereOf(const shared::SdfInstance& row, glm::dvec3 anchorWorld) {
  const glm::vec3 center =
      anchoredOf(row, glm::dvec3(glm::vec3(row.boxMin) + glm::vec3(row.boxMax)) * 0.5, anchorWorld);
  float radius = 0;
  for (int corner = 0; corner < 4; ++corner) // the other four lie opposite
    radius = std::max(radius, glm::distance(center, anchoredOf(row, cornerOf(row, corner), anchorWorld)));
  return {center, 1.0001f * radius + 1e-6f * glm::length(center)};
}

shared::FieldObjectRow fieldRowOf(const shared::SdfInstance& row, glm::dvec3 anchorWorld) {
  shared::FieldObjectRow result{};
  result.sphere = sphereOf(row, anchorWorld);
  for (int axis = 0; axis < 3; ++axis)
    result.gridFromAnchored[axis] = glm::vec4(
        glm::vec3(row.gridFromWorld[axis]), static_cast<float>(double{row.worldFromGrid[axis].w} - anchorWorld[axis]));
  result.boxMin = row.boxMin;
  result.boxMax = row.boxMax;
  const PointGrid grid = pointGridOf(glm::vec3(row.boxMin), glm::vec3(row.boxMax),
                                     static_cast<std::uint32_t>(row.ids.w) >> shared::SDF_FIELD_SHIFT);
  const glm::vec3 cell = grid.cellGrid;
  const float smallest = std::min({cell.x, cell.y, cell.z});
  result.points = glm::vec4(grid.firstGrid, grid.longestSide());
  result.pointCell = glm::vec4(cell, 0.125f * (glm::dot(cell, cell) - smallest * smallest));
  result.pointBlock =
      glm::vec4(glm::vec3(grid.firstTexel), glm::length(static_cast<float>(shared::NEAREST_POINTS - 1) * cell));
  result.ids = row.ids;
  return result;
}

bool meets(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

bool holds(const Box& outer, const Box& inner) {
  return !outer.isEmpty() && glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
         glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

/// The box, metres from the anchor, of what may leave its key in texels.
Box reachOf(const TexelBox& texels, const FieldWindow& window) {
  if (texels.isEmpty()) return {};
  const double margin = std::ceil(kFieldSplatTexels);
  return {glm::vec3((glm::dvec3(texels.min) - margin) * window.texelSize),
          glm::vec3((glm::dvec3(texels.max) + 1.0 + margin) * window.texelSize)};
}

} // namespace

Box WorldField::anchoredBounds() const {
  if (boundsWorld_.isEmpty()) return {};
  return {glm::vec3(glm::dvec3(boundsWorld_.min) - anchorWorld_),
          glm::vec3(glm::dvec3(boundsWorld_.max) - anchorWorld_)};
}

FieldShape WorldField::sizedShape() const {
  FieldShape shape = shape_;
  shape.texelSize = texelSize_;
  return shape;
}

glm::dvec3 WorldField::anchorFor(const Box& boundsWorld, glm::dvec3 eyeWorld) {
  const bool isUsable = !boundsWorld.isEmpty() && isFinite(boundsWorld.min) && isFinite(boundsWorld.max);
  if (shape_.isWhole) {
    if (isUsable && !holds(boundsWorld_, boundsWorld)) {
      boundsWorld_.extend(boundsWorld);
      anchorWorld_ = 0.5 * (glm::dvec3(boundsWorld_.min) + glm::dvec3(boundsWorld_.max));
    }
    texelSize_ = fieldTexelSize(shape_, anchoredBounds());
    return anchorWorld_;
  }
  if (isUsable && (boundsWorld_.isEmpty() || texelSize_ == 0)) isAnchored_ = false, texelSize_ = 0;
  if (isUsable) boundsWorld_ = boundsWorld;
  if (texelSize_ == 0) texelSize_ = fieldTexelSize(shape_, anchoredBounds());
  // Near what the windows hold, which may be far from an eye outside of the scene.
  const glm::dvec3 focus = boundsWorld_.isEmpty()
                               ? eyeWorld
                               : glm::clamp(eyeWorld, glm::dvec3(boundsWorld_.min), glm::dvec3(boundsWorld_.max));
  const double side = texelSize_ * std::exp2(shape_.cascades - 1) * shape_.texels;
  const glm::dvec3 away = glm::abs(focus - anchorWorld_) / side;
  if (!isAnchored_ || std::max({away.x, away.y, away.z}) > kAnchorSides) anchorWorld_ = glm::round(focus / side) * side;
  isAnchored_ = true;
  return anchorWorld_;
}

std::vector<Box> WorldField::changedObjects(const ResidentScene& scene) {
  const std::vector<shared::SdfInstance>& now = scene.sdfInstances();
  std::vector<Box> boxes;
  const auto add = [&](const shared::SdfInstance& row) { boxes.push_back(boxOf(row, anchorWorld_)); };
  for (std::size_t i = 0; i < std::max(now.size(), objects_.size()); ++i) {
    const bool isHere = i < now.size(), wasHere = i < objects_.size();
    if (isHere && wasHere && std::memcmp(&now[i], &objects_[i], sizeof now[i]) == 0) continue;
    if (wasHere) add(objects_[i]);
    if (isHere) add(now[i]);
  }
  objects_ = now;
  return boxes;
}

std::vector<shared::FieldSplat> WorldField::splatsFor(const WorldTriangles& triangles,
                                                      const std::vector<TexelBox>& keyBounds,
                                                      const std::vector<FieldWindow>& windows) const {
  std::vector<shared::FieldSplat> splats;
  for (std::size_t cascade = 0; cascade < windows.size(); ++cascade) {
    const Box dirty = reachOf(keyBounds[cascade], windows[cascade]);
    if (dirty.isEmpty()) continue;
    for (const InstanceRange& range : triangles.instances()) {
      if (range.boundsAnchored.isEmpty() || !meets(range.boundsAnchored, dirty)) continue;
      for (std::uint32_t first = 0; first < range.count; first += shared::GATHER_TRIANGLES)
        splats.push_back({range.firstTriangle + first, std::min(shared::GATHER_TRIANGLES, range.count - first),
                          static_cast<std::uint32_t>(cascade), 0});
    }
  }
  return splats;
}

void WorldField::update(const WorldTriangles& triangles, const ResidentScene& scene, bool isNew, glm::dvec3 eyeWorld) {
  const std::vector<FieldWindow> windows = fieldWindows(sizedShape(), anchoredBounds(), eyeWorld - anchorWorld_);
  if (exact_.fit(windows) || isNew) planner_.reset();
  std::vector<Box> meshes;
  for (const MovedInstance& moved : triangles.moved()) {
    meshes.push_back(moved.boundsBefore);
    meshes.push_back(moved.boundsNow);
  }
  FieldWork work;
  work.tiles = planner_.plan(windows, meshes, changedObjects(scene));
  work.keyBounds = boundsOfTiles(windows, work.tiles.keys);
  work.splats = splatsFor(triangles, work.keyBounds, windows);
  work.anchorWorld = anchorWorld_;
  work.triangleCount = triangles.triangleCount();
  for (const shared::SdfInstance& object : scene.sdfInstances())
    work.objects.push_back(fieldRowOf(object, anchorWorld_));
  exact_.prepare(windows, work);
}

} // namespace brickfield
