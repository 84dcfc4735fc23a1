// Keeps the world field of one scene from frame to frame: made when a frame first reads it, handed to the passes as a
// FieldFrame, read back for tests and pictures.
#pragma once

#include <memory>
#include <optional>

#include "field/field_volume.h"
#include "passes/world_field/field_frame.h"
#include "passes/world_field/world_field.h"
#include "renderer/settings.h"
#include "resident/scene_hierarchy.h"
#include "scene/view.h"

namespace brickfield {

/// What the world field of the last frame cost; zeros where that frame read none.
struct FieldStats {
  FieldMethod method = FieldMethod::Off;
  std::uint32_t cascades = 0;
  std::uint32_t triangles = 0;      ///< of all mesh instances
  std::uint32_t movedInstances = 0; ///< of meshes
  std::uint32_t tiles = 0;          ///< that there are; this and what follows of the exact field
  std::uint32_t keyTiles = 0;       ///< made anew: surface keys
  std::uint32_t candidateTiles = 0; ///< nearest triangles
  std::uint32_t valueTiles = 0;     ///< distances
  struct Bytes {
    std::size_t triangles = 0; ///< where they stand, and what they are gathered by
    std::size_t hierarchy = 0; ///< of rtsdf
    std::size_t distances = 0; ///< volumes that are read
    std::size_t nodes = 0;
    std::size_t objects = 0; ///< nearest points around the fields of SDF objects
    std::size_t work = 0;    ///< everything else of the method
  } bytes;
};

class FieldKeeper {
public:
  /// scene, resident  must outlive this
  FieldKeeper(const Scene& scene, const SceneFields& fields, const ResidentScene& resident,
              const FieldSettings& settings);

  /// Plans and uploads a frame, for the pose that the resident scene was given. To be called once before the passes of
  /// each frame that makes the field; settle() after them.
  /// error  Failure: more triangles or texels than can be numbered, or no memory for them
  const FieldFrame& prepare(const Pose& pose, const View& view, const FieldSlice& slice);
  void settle();

  const WorldTriangles& triangles() const { return triangles_; }
  glm::dvec3 anchorWorld() const { return triangles_.anchorWorld(); }
  const FieldStats& stats() const { return stats_; }
  const FieldPicture& picture() const { return frame_.picture; }
  /// Waits for the GPU.
  FieldVolumes read() const;

private:
  void prepareExact(const Pose& pose, const View& view);
  void prepareRtsdf(const Pose& pose);
  FieldPicture pictureOf(const Pose& pose, const View& view, const FieldSlice& slice) const;
  Box shownBounds(const Pose& pose, int cascade) const;
  void count(std::uint32_t moved);

  const Scene* scene_;
  const ResidentScene* resident_;
  FieldSettings settings_;
  WorldTriangles triangles_;
  std::optional<WorldField> exact_;
  std::optional<RtsdfField> rtsdf_;
  std::optional<SceneHierarchy> hierarchy_;
  Buffer rtsdfParams_;
  std::optional<glm::dvec3> rtsdfAnchor_;
  Box rtsdfBounds_; ///< anchored; what the volume was laid around
  FieldFrame frame_;
  FieldStats stats_;
};

} // namespace brickfield
