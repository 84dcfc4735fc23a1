// Weighted sums over the eight samples of a voxel.
#include "field/surface_attributes.h"

#include "field/brick_layout.h"
#include "field/brick_lookup.h"

namespace brickfield {

namespace {

SurfaceAttributes unpackAttributes(const BrickLevel& level, std::size_t index) {
  const glm::vec4 color = unpackRgba8(level.baseColor[index]), material = unpackRgba8(level.material[index]);
  SurfaceAttributes a;
  a.baseColor = glm::vec4(linearFromSrgb(glm::vec3(color)), color.w);
  a.metallic = material.x, a.roughness = material.y, a.occlusion = material.z;
  a.unlit = material.w > 0.5f;
  if (!level.emission.empty()) a.emission = unpackRgb9e5(level.emission[index]);
  return a;
}

} // namespace

std::optional<SurfaceAttributes> attributesAt(const BrickField& field, std::size_t level, glm::vec3 pointObject) {
  const BrickLevel& bricks = field.levels[level];
  const glm::dvec3 at =
      glm::clamp((glm::dvec3(pointObject) - glm::dvec3(field.originObject)) / double{bricks.voxelSizeObject},
                 glm::dvec3(0), glm::dvec3(kBrickCells * bricks.brickCounts));
  const glm::ivec3 voxel = voxelAt(bricks, at), brick = brickOfVoxel(voxel);
  const IndirectionCell cell = cellAt(bricks, brick);
  if (bricks.baseColor.empty() || cell.isEmpty()) return std::nullopt;
  const glm::vec3 part(at - glm::dvec3(voxel));
  SurfaceAttributes sum;
  sum.baseColor = glm::vec4(0);
  sum.metallic = sum.roughness = sum.occlusion = 0;
  float unlit = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
    const glm::vec3 weights = glm::mix(1.0f - part, part, glm::vec3(corner));
    const float weight = weights.x * weights.y * weights.z;
    const std::size_t index =
        std::size_t{cell.brickIndex()} * kBrickSampleCount + sampleIndex(voxel - kBrickCells * brick + corner);
    const SurfaceAttributes a = unpackAttributes(bricks, index);
    sum.baseColor += weight * a.baseColor;
    sum.metallic += weight * a.metallic;
    sum.roughness += weight * a.roughness;
    sum.occlusion += weight * a.occlusion;
    sum.emission += weight * a.emission;
    unlit += a.unlit ? weight : 0.0f;
  }
  sum.unlit = unlit > 0.5f;
  return sum;
}

} // namespace brickfield
