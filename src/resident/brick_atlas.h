// All brick fields on the GPU: pools for distances (8 and 16 bits) and attributes, the indirection cells and the level
// table. Fields come and go; what a field held is given to the next.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "field/brick_field.h"
#include "gpu/buffer.h"
#include "resident/brick_pool.h"
#include "shared/sdf_params.h"

namespace brickfield {

/// What an instance needs to know of a resident field.
struct ResidentField {
  std::uint32_t firstLevel = 0; ///< row of the level table
  std::uint32_t levelCount = 0;
  std::uint32_t number = 0;  ///< small, and no other resident field's
  float voxelSizeObject = 0; ///< of the finest level
  glm::vec3 originObject{0};
  Box boundsObject;
};

class BrickAtlas {
public:
  BrickAtlas();

  using FieldId = std::uint32_t; ///< no two are the same, of whatever atlas
  /// Makes room for these fields at once, so that adding them moves nothing.
  void reserve(const std::vector<BrickField>& fields);
  /// Uploads a field that validateField accepts.
  /// error Failure: out of slots or memory
  FieldId add(const BrickField& field);
  /// Frees the field's slots, cells and rows; instances must not refer to it any more.
  void remove(FieldId id);
  const ResidentField& field(FieldId id) const;
  /// Of all fields, in no order that counts.
  std::vector<FieldId> fieldIds() const;
  std::uint32_t numbersEnd() const { return numbers_.end(); } ///< no field's number is as large

  /// Binds textures, level table and indirection for the programs that include lib/bricks.glsl.
  void bind() const;
  std::size_t bytes() const;
  std::uint32_t brickCount() const { return distances8_.usedSlots() + distances16_.usedSlots(); }

private:
  struct Allocation {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  struct HeldLevel {
    bool isR16 = false;
    Allocation distances, attributes, cells, attributeCells;
  };
  struct HeldField {
    ResidentField resident;
    std::vector<HeldLevel> levels;
    std::vector<shared::SdfLevel> rows;
  };
  shared::SdfLevel addLevel(const BrickLevel& level, float scale, HeldLevel& held);
  void uploadRows(HeldField& held);
  /// Rows know how deep their pool is: all are told again when one has grown.
  void renewRows();
  std::uint32_t addCells(const BrickLevel& level, std::uint32_t firstSlot, Allocation& held);

  BrickPool distances8_, distances16_, attributes_;
  Buffer levelTable_, indirection_;
  RangeAllocator levelRows_, cells_, numbers_;
  std::unordered_map<FieldId, HeldField> fields_;
  int depth8_ = 0, depth16_ = 0; ///< of the pools, as the rows know them
};

} // namespace brickfield
