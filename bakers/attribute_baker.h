// Surface attributes at points of triangles, packed as bricks store them: the material's factors, textures and vertex
// colours, filtered to a voxel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bakers/mesh_distance.h"
#include "scene/texture_sampling.h"

namespace brickfield {

struct PackedAttributes {
  std::uint32_t baseColor = 0; ///< as BrickLevel::baseColor
  std::uint32_t material = 0;
  std::uint32_t emission = 0;

  bool operator==(const PackedAttributes&) const = default;
};

class AttributeBaker {
public:
  /// input, soup   must outlive this
  /// hasThinCards  what a mask cut has a slab as thin as can be shown: it is to know which way its card faces
  AttributeBaker(const BakeInput& input, const TriangleSoup& soup, bool hasThinCards);

  /// True if all points of all triangles have the same attributes.
  bool isUniform() const { return isUniform_; }
  /// True if any material of the input can emit.
  bool hasEmission() const { return hasEmission_; }

  /// on          a point of the triangle
  /// sample      soup space, closest to it: tells the coverage of what a mask was cut into
  /// voxelMetres object space: textures are filtered to a square of this width
  /// cost        a table look-up where the primitive has neither textures nor vertex colours
  PackedAttributes at(std::uint32_t triangle, const PointOnTriangle& on, glm::dvec3 sample, float voxelMetres) const;

  /// Whether the triangle's material shows its front alone and no other triangle covers its back.
  bool isSingleSided(std::uint32_t triangle) const;

private:
  /// The same by weights in the triangle of the primitive.
  PackedAttributes atParent(std::uint32_t triangle, glm::vec2 barycentric, float footprintMetres) const;
  float keptShare(std::uint32_t piece, glm::dvec3 sample, float voxelMetres) const;
  PackedAttributes sample(const Material& material, const MaterialPoint& point) const;

  const BakeInput* input_;
  const TriangleSoup* soup_;
  TextureSampler sampler_;
  std::vector<std::optional<PackedAttributes>> constants_; ///< a primitive: what it has everywhere
  bool hasThinCards_;
  bool isUniform_ = true;
  bool hasEmission_ = false;
};

} // namespace brickfield
