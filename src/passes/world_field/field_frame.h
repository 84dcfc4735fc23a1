// What the passes of the world field work on in one frame, and how those that read it are given it.
#pragma once

#include "gpu/buffer.h"
#include "passes/world_field/exact_field.h"
#include "passes/world_field/rtsdf_field.h"
#include "resident/triangle_hierarchy.h"

namespace brickfield {

/// The plane that a view cuts through the field; lengths in anchored space.
struct FieldPicture {
  glm::vec3 centerAnchored{0.0f};
  glm::vec3 rightAnchored{1, 0, 0}; ///< metres a pixel
  glm::vec3 upAnchored{0, 1, 0};
  int cascade = -1; ///< -1: the finest at each point
};

struct FieldFrame {
  ExactField* exact = nullptr; ///< one of the two methods
  RtsdfField* rtsdf = nullptr;
  const TriangleHierarchy* hierarchy = nullptr; ///< of rtsdf
  const Buffer* rtsdfParams = nullptr;          ///< shared::FieldParams of its one volume
  FieldPicture picture;

  std::size_t cascadeCount() const { return exact ? exact->windows().size() : 1; }
};

/// Binds what lib/world_field.glsl and lib/world_field_nodes.glsl read. Only the exact field knows nodes.
void bindWorldField(const FieldFrame& field);

} // namespace brickfield
