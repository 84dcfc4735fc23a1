// Which mesh draws a view may see, the camera's or a light's, and in which order they hide each other best.
#pragma once

#include <span>
#include <vector>

#include "core/math.h"
#include "resident/resident_scene.h"
#include "scene/view.h"

namespace brickfield {

/// The mesh draws of a scene as views choose among them.
struct MeshDraws {
  const std::vector<MeshBatch>& batches;
  std::span<const Box> boxesAnchored; ///< of each draw, metres from the anchor; empty ones hold nothing
  glm::dvec3 anchorWorld{0};
};

/// Neighbouring draws of one batch.
struct DrawRun {
  std::uint32_t batch = 0;
  std::uint32_t firstDraw = 0;
  std::uint32_t drawCount = 0;
};

/// In the order of the batches. A draw is left out if its box lies wholly outside of one plane of the view; nothing is
/// ever too far.
///
/// proved by tests/unit/passes/visible_draws_test.cpp
std::vector<DrawRun> visibleDraws(const MeshDraws& draws, const View& view);

/// The same runs by the farthest corners of their boxes, nearest first, so that what is hidden is not shaded; rooms and
/// grounds, which begin at the eye and hide nothing, come last. Distances within a factor of the square root of two
/// count as one: there the order of the batches stays, in which states change seldom.
std::vector<DrawRun> frontToBack(std::vector<DrawRun> runs, const MeshDraws& draws, const View& view);

} // namespace brickfield
