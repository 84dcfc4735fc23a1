// Boxes around a primitive wherever a pose puts it, without touching its vertices: joints carry boxes of the vertices
// that they move, morph targets widen them.
#pragma once

#include <vector>

#include "scene/pose.h"

namespace brickfield {

class InstanceBounds {
public:
  /// cost one look at each vertex, influence and target
  explicit InstanceBounds(const Primitive& primitive);

  /// Box of all vertices as the GPU places them (deformed in float, then moved by floats), relative to the anchor.
  /// Vertices that are not finite are in no box.
  ///
  /// instance    of the primitive's mesh; weights of joints are none below 0, as imported
  /// anchorWorld metres
  /// bound       each vertex lies within a box of its joints' boxes: tight where limbs are
  /// proved by   tests/unit/scene/instance_bounds_test.cpp
  Box anchored(const PosedInstance& instance, glm::dvec3 anchorWorld) const;

private:
  struct Range {
    glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  };
  Range morphed(const Range& rest, const PosedInstance& instance) const;

  Range rest_;
  std::vector<Range> joints_;  ///< rest positions of what a joint moves; skinned only
  std::vector<Range> targets_; ///< offsets
  double weightError_ = 0;     ///< largest |1 - sum of a vertex's weights|
};

} // namespace brickfield
