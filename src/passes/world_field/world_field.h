// What the world field is to a frame: it keeps the anchor, the windows and the boxes of what moved from one frame to
// the next, and hands each update to the passes.
#pragma once

#include "field/field_windows.h"
#include "passes/world_field/exact_field.h"
#include "resident/resident_scene.h"
#include "resident/world_triangles.h"

namespace brickfield {

class WorldField {
public:
  explicit WorldField(const FieldShape& shape) : shape_(shape) {}

  /// Where positions are counted from this frame; to be given to WorldTriangles::setPose before update(). Moves only
  /// when the eye has gone far: then everything is made anew.
  ///
  /// boundsWorld  of the scene; the first that is not empty decides the size of texels where the shape leaves it open.
  ///              The one window of a whole scene grows, all anew, when the scene leaves it
  glm::dvec3 anchorFor(const Box& boundsWorld, glm::dvec3 eyeWorld);

  /// Plans and uploads a frame's work, for the pose that `triangles` and `scene` have. The triangles must not have been
  /// settled since.
  ///
  /// isNew  what WorldTriangles::setPose said
  void update(const WorldTriangles& triangles, const ResidentScene& scene, bool isNew, glm::dvec3 eyeWorld);

  ExactField& exact() { return exact_; }
  const ExactField& exact() const { return exact_; }

private:
  std::vector<Box> changedObjects(const ResidentScene& scene);
  std::vector<shared::FieldSplat> splatsFor(const WorldTriangles& triangles, const std::vector<TexelBox>& keyBounds,
                                            const std::vector<FieldWindow>& windows) const;
  Box anchoredBounds() const;
  FieldShape sizedShape() const;

  FieldShape shape_;
  FieldUpdatePlanner planner_;
  ExactField exact_;
  Box boundsWorld_;
  double texelSize_ = 0; ///< of the finest cascade; 0: not known yet
  glm::dvec3 anchorWorld_{0};
  bool isAnchored_ = false;
  std::vector<shared::SdfInstance> objects_; ///< of the frame before
};

} // namespace brickfield
