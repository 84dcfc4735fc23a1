// The nearest surface points around every field that SDF objects draw, on a grid each: made once from the bricks, so
// that what lies outside an object's box finds its surface by one read (lib/near_point.glsl) instead of a search.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/shader_library.h"
#include "gpu/texture.h"
#include "resident/brick_atlas.h"

namespace brickfield {

/// Where the points around a field lie.
struct PointGrid {
  glm::vec3 firstGrid{0}; ///< grid space of the field, as all here
  glm::vec3 cellGrid{0};
  glm::ivec3 firstTexel{0}; ///< of their block of the texture

  float longestSide() const { return std::max({cellGrid.x, cellGrid.y, cellGrid.z}); }
};
PointGrid pointGridOf(const glm::vec3& boxMinGrid, const glm::vec3& boxMaxGrid, std::uint32_t fieldNumber);

class NearestPoints {
public:
  explicit NearestPoints(ShaderLibrary& shaders);

  /// Makes the grids of fields that came since. The atlas must be bound; image stores and storage writes need barriers
  /// behind it, which it sets. error Failure: the device has no memory for them
  void fit(const BrickAtlas& atlas);
  /// For a program that includes lib/near_point.glsl and is in use.
  void bind(Program& program) const;
  /// Of the grids around an atlas' fields.
  static std::size_t bytesFor(const BrickAtlas& atlas);

private:
  void make(const ResidentField& field);

  std::shared_ptr<Program> program_;
  std::vector<BrickAtlas::FieldId> made_; ///< by their fields' numbers; 0: none
  Texture texture_;
};

} // namespace brickfield
