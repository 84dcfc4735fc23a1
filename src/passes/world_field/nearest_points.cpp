// Blocks of a texture, x fastest, by the fields' numbers; what is made is made again when the texture must grow.
#include "passes/world_field/nearest_points.h"

#include <array>

#include "shared/bindings.h"
#include "shared/world_field_params.h"

namespace brickfield {

namespace {

constexpr int kSide = static_cast<int>(shared::NEAREST_POINTS), kPoints = kSide * kSide * kSide;
constexpr int kBlocks = static_cast<int>(shared::NEAREST_POINT_BLOCKS);
constexpr int kRounds = 4; // one alone, and three among neighbours

glm::ivec3 extentFor(int fields) {
  const int rows = ceilDivide(fields, kBlocks);
  return glm::ivec3(std::min(fields, kBlocks), std::min(rows, kBlocks), ceilDivide(rows, kBlocks)) * kSide;
}

std::uint32_t fieldNumberOf(const shared::SdfInstance& row) {
  return static_cast<std::uint32_t>(row.ids.w) >> shared::SDF_FIELD_SHIFT;
}

/// By the fields' numbers: whether an SDF object draws it.
std::vector<bool> drawnFields(const ResidentScene& scene) {
  std::vector<bool> drawn;
  for (std::uint32_t i = 0; i < scene.sdfInstanceCount(); ++i) {
    const std::size_t number = fieldNumberOf(scene.sdfInstances()[i]);
    if (number >= drawn.size()) drawn.resize(number + 1);
    drawn[number] = true;
  }
  return drawn;
}

} // namespace

PointGrid pointGridOf(const glm::vec3& boxMinGrid, const glm::vec3& boxMaxGrid, std::uint32_t fieldNumber) {
  const glm::vec3 extent = boxMaxGrid - boxMinGrid;
  const float margin = shared::NEAREST_POINT_MARGIN * std::max({extent.x, extent.y, extent.z});
  const int number = static_cast<int>(fieldNumber);
  return {boxMinGrid - margin, (extent + 2 * margin) / static_cast<float>(kSide - 1),
          glm::ivec3(number % kBlocks, number / kBlocks % kBlocks, number / (kBlocks * kBlocks)) * kSide};
}

NearestPoints::NearestPoints(ShaderLibrary& shaders)
    : program_(shaders.load({"nearest_points", {{GL_COMPUTE_SHADER, "passes/nearest_points.comp.glsl"}}, {}, {}})) {}

void NearestPoints::make(const ResidentField& field, std::span<const Buffer, 2> points) {
  const glm::vec3 boxMin = (field.boundsObject.min - field.originObject) / field.voxelSizeObject;
  const glm::vec3 boxMax = (field.boundsObject.max - field.originObject) / field.voxelSizeObject;
  const PointGrid grid = pointGridOf(boxMin, boxMax, field.number);
  program_->use();
  program_->set("boxMin", boxMin);
  program_->set("boxMax", boxMax);
  program_->set("levels", glm::ivec2(field.firstLevel, field.levelCount));
  program_->set("firstTexel", grid.firstTexel);
  program_->set("firstPoint", grid.firstGrid);
  program_->set("cell", grid.cellGrid);
  for (int round = 0; round < kRounds; ++round) {
    program_->set("isFirst", round == 0);
    program_->set("isLast", round == kRounds - 1);
    points[static_cast<std::size_t>(round & 1)].bindStorage(shared::kNearestPointBinding);
    points[static_cast<std::size_t>(1 - (round & 1))].bindStorage(shared::kNearestPointBinding + 1);
    program_->dispatchOver({kPoints, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
}

void NearestPoints::fit(const ResidentScene& scene) {
  const std::vector<bool> drawn = drawnFields(scene);
  const glm::ivec3 extent = extentFor(static_cast<int>(drawn.size()));
  if (!drawn.empty() && (!texture_ || glm::any(glm::greaterThan(extent, texture_.extent())))) {
    texture_ = {}; // before there is a larger one
    texture_ = Texture::make3D("nearest_points", GL_RGBA16, extent);
    made_.clear();
  }
  made_.resize(std::max(made_.size(), drawn.size()));
  std::vector<BrickAtlas::FieldId> wanted;
  for (const BrickAtlas::FieldId id : scene.atlas().fieldIds()) {
    const std::uint32_t number = scene.atlas().field(id).number;
    if (number < drawn.size() && drawn[number] && made_[number] != id) wanted.push_back(id);
  }
  if (wanted.empty()) return;
  const std::array<Buffer, 2> points{Buffer("nearest_points", kPoints * sizeof(glm::vec4)),
                                     Buffer("nearest_points", kPoints * sizeof(glm::vec4))};
  texture_.bindImage(0, 0, GL_WRITE_ONLY);
  for (const BrickAtlas::FieldId id : wanted) {
    const ResidentField& field = scene.atlas().field(id);
    make(field, points);
    made_[field.number] = id;
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

std::size_t NearestPoints::bytesFor(const ResidentScene& scene) {
  const glm::ivec3 extent = extentFor(static_cast<int>(drawnFields(scene).size()));
  return 8 * std::size_t(extent.x) * std::size_t(extent.y) * std::size_t(extent.z);
}

void NearestPoints::bind(Program& program) const {
  program.set("nearestPointTexel", 1.0f / glm::vec3(texture_.extent()));
  texture_.bind(shared::kNearestPointUnit);
}

} // namespace brickfield
