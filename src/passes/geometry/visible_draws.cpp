// Planes in clip space; of each box the corner that lies farthest inside.
#include "passes/geometry/visible_draws.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace brickfield {

namespace {

// Of the sides and the near plane: what is inside has no negative product with any.
std::array<glm::dvec4, 5> planesAnchored(const MeshDraws& draws, const View& view) {
  glm::dmat4 eyeFromAnchored(1.0);
  eyeFromAnchored[3] = glm::dvec4(draws.anchorWorld - glm::dvec3(view.eyeWorld), 1.0);
  const glm::dmat4 rows = glm::transpose(clipFromEye(view) * eyeFromAnchored);
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
          rows[3] - rows[2]}; // reverse Z: nearer is above w
}

bool isOutside(const Box& box, const glm::dvec4& plane) {
  const glm::dvec3 normal(plane), center = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  const glm::dvec3 half = 0.5 * (glm::dvec3(box.max) - glm::dvec3(box.min));
  return glm::dot(normal, center) + glm::dot(glm::abs(normal), half) + plane.w < 0;
}

// Metres along the view from the eye to the farthest corner.
double farthestDepth(const Box& box, glm::dvec3 anchorWorld, const View& view) {
  const glm::dvec3 forward = -glm::dvec3(view.worldFromView[2]);
  const glm::bvec3 isMax = glm::greaterThan(forward, glm::dvec3(0));
  const glm::dvec3 corner = glm::mix(glm::dvec3(box.min), glm::dvec3(box.max), isMax);
  return glm::dot(forward, corner + anchorWorld - glm::dvec3(view.eyeWorld));
}

int depthStep(double metres) {
  constexpr double kNearest = 1e-3;
  return static_cast<int>(std::floor(2 * std::log2(std::max(metres, kNearest))));
}

} // namespace

std::vector<DrawRun> visibleDraws(const MeshDraws& draws, const View& view) {
  const std::array<glm::dvec4, 5> planes = planesAnchored(draws, view);
  std::vector<DrawRun> runs;
  for (std::uint32_t i = 0; i < draws.batches.size(); ++i) {
    const MeshBatch& batch = draws.batches[i];
    for (std::uint32_t draw = batch.firstDraw; draw < batch.firstDraw + batch.drawCount; ++draw) {
      const Box& box = draws.boxesAnchored[draw];
      const auto isBoxOutside = [&](const glm::dvec4& plane) { return isOutside(box, plane); };
      if (box.isEmpty() || std::any_of(planes.begin(), planes.end(), isBoxOutside)) continue;
      if (runs.empty() || runs.back().batch != i || runs.back().firstDraw + runs.back().drawCount != draw)
        runs.push_back({i, draw, 0});
      ++runs.back().drawCount;
    }
  }
  return runs;
}

std::vector<DrawRun> frontToBack(std::vector<DrawRun> runs, const MeshDraws& draws, const View& view) {
  struct Placed {
    int step;
    DrawRun run;
  };
  std::vector<Placed> placed;
  placed.reserve(runs.size());
  for (const DrawRun& run : runs) {
    double farthest = 0;
    for (std::uint32_t draw = run.firstDraw; draw < run.firstDraw + run.drawCount; ++draw)
      farthest = std::max(farthest, farthestDepth(draws.boxesAnchored[draw], draws.anchorWorld, view));
    placed.push_back({depthStep(farthest), run});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.step < b.step; });
  std::transform(placed.begin(), placed.end(), runs.begin(), [](const Placed& it) { return it.run; });
  return runs;
}

} // namespace brickfield
