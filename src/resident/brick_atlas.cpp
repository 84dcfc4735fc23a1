// Attributes have slots of their own, because objects differ in format and some carry none: a level's attribute cells
// stand beside its distance cells.
#include "resident/brick_atlas.h"

#include <algorithm>
#include <atomic>

#include "core/error.h"
#include "shared/bindings.h"

namespace brickfield {

namespace {
enum AttributeChannel : std::size_t { kBaseColor = 0, kMaterial = 1, kEmission = 2 };
} // namespace

BrickAtlas::BrickAtlas()
    : distances8_({{"distance_r8", GL_R8_SNORM}}),
      distances16_({{"distance_r16", GL_R16_SNORM}}),
      attributes_(
          {{"brick_base_color", GL_SRGB8_ALPHA8}, {"brick_material", GL_RGBA8}, {"brick_emission", GL_RGB9_E5}}),
      levelTable_("sdf_levels", sizeof(shared::SdfLevel) * 64),
      indirection_("indirection", sizeof(std::uint32_t) * 4096) {}

void BrickAtlas::reserve(const std::vector<BrickField>& fields) {
  std::uint32_t bricks8 = 0, bricks16 = 0, bricksWithAttributes = 0;
  std::size_t cells = 0;
  for (const BrickField& field : fields)
    for (const BrickLevel& level : field.levels) {
      (level.format == DistanceFormat::R16Snorm ? bricks16 : bricks8) += level.brickCount();
      if (!level.baseColor.empty()) bricksWithAttributes += level.brickCount();
      cells += level.indirection.size() * (level.baseColor.empty() ? 1 : 2);
    }
  distances8_.fit(bricks8);
  distances16_.fit(bricks16);
  attributes_.fit(bricksWithAttributes);
  indirection_.growTo((cells_.end() + cells) * sizeof(std::uint32_t));
  renewRows();
}

void BrickAtlas::uploadRows(HeldField& held) {
  for (std::size_t i = 0; i < held.rows.size(); ++i)
    held.rows[i].scale.w = 1.0f / static_cast<float>(held.levels[i].isR16 ? depth16_ : depth8_);
  levelTable_.upload(std::size_t{held.resident.firstLevel} * sizeof(shared::SdfLevel), held.rows);
}

void BrickAtlas::renewRows() {
  const int depth8 = distances8_.texture(0).depth(), depth16 = distances16_.texture(0).depth();
  if (depth8 == depth8_ && depth16 == depth16_) return;
  depth8_ = depth8;
  depth16_ = depth16;
  for (auto& [id, held] : fields_) uploadRows(held);
}

std::uint32_t BrickAtlas::addCells(const BrickLevel& level, std::uint32_t firstSlot, Allocation& held) {
  std::vector<std::uint32_t> cells = level.indirection;
  for (std::uint32_t& cell : cells)
    if (!IndirectionCell{cell}.isEmpty()) cell += firstSlot;
  held.count = static_cast<std::uint32_t>(cells.size());
  held.first = cells_.allocate(held.count);
  indirection_.growTo(std::size_t{cells_.end()} * sizeof(std::uint32_t));
  indirection_.upload(std::size_t{held.first} * sizeof(std::uint32_t), cells);
  return held.first;
}

shared::SdfLevel BrickAtlas::addLevel(const BrickLevel& level, float scale, HeldLevel& held) {
  held.isR16 = level.format == DistanceFormat::R16Snorm;
  BrickPool& pool = held.isR16 ? distances16_ : distances8_;
  held.distances.count = level.brickCount();
  held.distances.first = pool.allocate(held.distances.count);
  pool.fit();
  pool.upload(0, held.distances.first, level.distances);

  shared::SdfLevel row{};
  row.cells = glm::uvec4(addCells(level, held.distances.first, held.cells), glm::uvec3(level.brickCounts));
  row.scale = glm::vec4(scale, level.rangeVoxels, held.isR16 ? 1.0f : 0.0f, 0.0f);
  row.attributes.x = shared::SDF_NO_ATTRIBUTES;
  if (!level.baseColor.empty()) {
    held.attributes.count = level.brickCount();
    held.attributes.first = attributes_.allocate(held.attributes.count);
    attributes_.fit();
    attributes_.upload(kBaseColor, held.attributes.first, std::as_bytes(std::span(level.baseColor)));
    attributes_.upload(kMaterial, held.attributes.first, std::as_bytes(std::span(level.material)));
    // Slots are used again: what does not emit must say so.
    const std::vector<std::uint32_t> dark(level.emission.empty() ? level.baseColor.size() : 0, 0u);
    attributes_.upload(kEmission, held.attributes.first,
                       std::as_bytes(std::span(level.emission.empty() ? dark : level.emission)));
    row.attributes.x = addCells(level, held.attributes.first, held.attributeCells);
  }
  return row;
}

BrickAtlas::FieldId BrickAtlas::add(const BrickField& field) {
  if (const std::string fault = validateField(field); !fault.empty()) throw Failure("brick atlas: " + fault);
  HeldField held;
  held.resident.levelCount = static_cast<std::uint32_t>(field.levels.size());
  held.resident.firstLevel = levelRows_.allocate(held.resident.levelCount);
  held.resident.number = numbers_.allocate(1);
  held.resident.voxelSizeObject = field.levels[0].voxelSizeObject;
  held.resident.originObject = field.originObject;
  held.resident.boundsObject = field.boundsObject;
  for (const BrickLevel& level : field.levels)
    held.rows.push_back(
        addLevel(level, field.levels[0].voxelSizeObject / level.voxelSizeObject, held.levels.emplace_back()));
  levelTable_.growTo(std::size_t{levelRows_.end()} * sizeof(shared::SdfLevel));
  renewRows();
  uploadRows(held);
  static std::atomic<FieldId> nextId{1};
  const FieldId id = nextId++;
  fields_.emplace(id, std::move(held));
  return id;
}

void BrickAtlas::remove(FieldId id) {
  const auto found = fields_.find(id);
  if (found == fields_.end()) throw Failure("brick atlas: no such field");
  for (const HeldLevel& level : found->second.levels) {
    (level.isR16 ? distances16_ : distances8_).release(level.distances.first, level.distances.count);
    attributes_.release(level.attributes.first, level.attributes.count);
    cells_.release(level.cells.first, level.cells.count);
    cells_.release(level.attributeCells.first, level.attributeCells.count);
  }
  levelRows_.release(found->second.resident.firstLevel, found->second.resident.levelCount);
  numbers_.release(found->second.resident.number, 1);
  fields_.erase(found);
}

const ResidentField& BrickAtlas::field(FieldId id) const {
  const auto found = fields_.find(id);
  if (found == fields_.end()) throw Failure("brick atlas: no such field");
  return found->second.resident;
}

std::vector<BrickAtlas::FieldId> BrickAtlas::fieldIds() const {
  std::vector<FieldId> ids;
  for (const auto& [id, held] : fields_) ids.push_back(id);
  return ids;
}

void BrickAtlas::bind() const {
  distances8_.texture(0).bind(shared::kDistanceR8Unit);
  distances16_.texture(0).bind(shared::kDistanceR16Unit);
  attributes_.texture(kBaseColor).bind(shared::kBrickBaseColorUnit);
  attributes_.texture(kMaterial).bind(shared::kBrickMaterialUnit);
  attributes_.texture(kEmission).bind(shared::kBrickEmissionUnit);
  levelTable_.bindStorage(shared::kSdfLevelBinding);
  indirection_.bindStorage(shared::kIndirectionBinding);
}

std::size_t BrickAtlas::bytes() const {
  return distances8_.bytes() + distances16_.bytes() + attributes_.bytes() + levelTable_.bytes() + indirection_.bytes();
}

} // namespace brickfield
