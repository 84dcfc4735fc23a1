// Which mesh draws a light's view may see; what lies beside it or behind it casts no shadow there.
#pragma once

#include <vector>

#include "core/math.h"
#include "resident/resident_scene.h"
#include "scene/view.h"

namespace brickfield {

/// The mesh draws of a scene as a light's views choose among them.
struct ShadowCasters {
  const std::vector<MeshBatch>& batches;
  std::vector<Box> boxesAnchored; ///< of each draw, metres from the anchor; empty ones hold nothing
  glm::dvec3 anchorWorld{0};
};

/// Neighbouring draws of one batch.
struct CasterRun {
  std::uint32_t batch = 0;
  std::uint32_t firstDraw = 0;
  std::uint32_t drawCount = 0;
};

/// In the order of the batches. A draw is left out if its box lies wholly outside of one plane of the view; nothing is
/// ever too far.
///
/// proved by tests/unit/passes/shadow_casters_test.cpp
std::vector<CasterRun> castersOf(const ShadowCasters& casters, const View& view);

} // namespace brickfield
