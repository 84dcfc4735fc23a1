// Corners in clip space, a bit for each plane that one is outside of.
#include "passes/light/shadow_casters.h"

namespace brickfield {

namespace {

// Reverse Z: nearer than the near plane is above w.
bool isOutside(const Box& box, const glm::dmat4& clipFromAnchored) {
  unsigned outside = 0x1f;
  for (unsigned corner = 0; corner < 8 && outside; ++corner) {
    const glm::dvec4 clip =
        clipFromAnchored * glm::dvec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                      corner & 4 ? box.max.z : box.min.z, 1.0);
    outside &= unsigned{clip.x < -clip.w} | unsigned{clip.x > clip.w} << 1 | unsigned{clip.y < -clip.w} << 2 |
               unsigned{clip.y > clip.w} << 3 | unsigned{clip.z > clip.w} << 4;
  }
  return outside != 0;
}

} // namespace

std::vector<CasterRun> castersOf(const ShadowCasters& casters, const View& view) {
  glm::dmat4 eyeFromAnchored(1.0);
  eyeFromAnchored[3] = glm::dvec4(casters.anchorWorld - glm::dvec3(view.eyeWorld), 1.0);
  const glm::dmat4 clipFromAnchored = clipFromEye(view) * eyeFromAnchored;
  std::vector<CasterRun> runs;
  for (std::uint32_t i = 0; i < casters.batches.size(); ++i) {
    const MeshBatch& batch = casters.batches[i];
    for (std::uint32_t draw = batch.firstDraw; draw < batch.firstDraw + batch.drawCount; ++draw) {
      const Box& box = casters.boxesAnchored[draw];
      if (box.isEmpty() || isOutside(box, clipFromAnchored)) continue;
      if (runs.empty() || runs.back().batch != i || runs.back().firstDraw + runs.back().drawCount != draw)
        runs.push_back({i, draw, 0});
      ++runs.back().drawCount;
    }
  }
  return runs;
}

} // namespace brickfield
