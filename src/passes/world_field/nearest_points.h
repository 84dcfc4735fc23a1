// The nearest surface points around every field that SDF objects draw, on a grid each: made once from the bricks, so
// that what lies outside an object's box finds its surface by one read (lib/near_point.glsl) instead of a search.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/shader_library.h"
#include "gpu/texture.h"
#include "resident/resident_scene.h"

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

  /// Makes the grids of fields that came since, of those that SDF objects draw. The atlas must be bound; it sets the
  /// barriers behind its stores. error Failure: the device has no memory for them
  void fit(const ResidentScene& scene);
  /// For a program that includes lib/near_point.glsl and is in use.
  void bind(Program& program) const;
  /// Of the grids for a scene: whole rows of 16 fields, and whole layers of 256.
  static std::size_t bytesFor(const ResidentScene& scene);

private:
  void make(const ResidentField& field, std::span<const Buffer, 2> points);

  std::shared_ptr<Program> program_;
  std::vector<BrickAtlas::FieldId> made_; ///< by their fields' numbers; 0: none
  Texture texture_;
};

} // namespace brickfield
