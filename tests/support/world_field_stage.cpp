// Runs the passes with a barrier for everything between them.
#include "tests/support/world_field_stage.h"

#include "passes/frame_context.h"

namespace brickfield::test {

glm::ivec3 FieldSnapshot::latticeOf(std::size_t texel) const {
  const auto side = static_cast<std::size_t>(window.texels);
  return window.firstTexel + glm::ivec3(texel % side, texel / side % side, texel / (side * side));
}

WorldFieldStage::WorldFieldStage(const Scene& scene, const SceneFields& fields, const FieldShape& shape)
    : scene_(scene),
      resident_(scene, fields),
      triangles_(scene, fields, resident_),
      field_(shape),
      shaders_(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders"),
      deform_(shaders_),
      clear_(shaders_),
      gather_(shaders_),
      pseudonormals_(shaders_),
      splat_(shaders_),
      candidates_(shaders_),
      resolve_(shaders_) {}

void WorldFieldStage::frame(const Pose& pose, glm::dvec3 eyeWorld) {
  resident_.setPose(scene_, pose);
  const glm::dvec3 anchor = field_.anchorFor(pose.boundsWorld, eyeWorld);
  const bool isNew = triangles_.setPose(scene_, pose, anchor);
  field_.update(triangles_, resident_, isNew, eyeWorld);

  FrameTargets targets({4, 4});
  const VisibleBoxes visible;
  const Buffer counters("counters", 64);
  const Texture none;
  FrameContext context{resident_, targets, visible, counters, none, none};
  context.worldTriangles = &triangles_;
  const auto barrier = [] { glMemoryBarrier(GL_ALL_BARRIER_BITS); };
  deform_.record(context), barrier();
  clear_.record(field_.exact()), barrier();
  gather_.record(context), barrier();
  pseudonormals_.record(context), barrier();
  splat_.record(field_.exact(), triangles_.triangles()), barrier();
  candidates_.record(field_.exact(), triangles_.triangles()), barrier();
  resolve_.record(field_.exact(), triangles_.triangles(), resident_), barrier();
  triangles_.settle();
}

void WorldFieldStage::frameAt(double seconds, glm::dvec3 eyeWorld) {
  PoseRequest request;
  if (seconds >= 0) request.seconds = seconds;
  frame(poseScene(scene_, request), eyeWorld);
}

FieldSnapshot WorldFieldStage::read(std::size_t cascade) const {
  const ExactField& exact = field_.exact();
  const FieldWindow& window = exact.windows()[cascade];
  FieldSnapshot snapshot{window, triangles_.anchorWorld(), {}, {}};
  const std::vector<float> stored = exact.distances(cascade).readFloats(0);
  std::size_t firstTexel = 0;
  for (std::size_t i = 0; i < cascade; ++i)
    firstTexel += std::size_t(1) << 3 * (std::bit_width(unsigned(exact.windows()[i].texels)) - 1);
  const auto nodes = exact.nodes().read<std::uint32_t>(firstTexel * 4, stored.size());
  const int mask = window.texels - 1, tiles = window.tiles();
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const glm::ivec3 slot = snapshot.latticeOf(i) & mask;
    snapshot.distances.push_back(
        stored[static_cast<std::size_t>((slot.z * window.texels + slot.y) * window.texels + slot.x)]);
    const glm::ivec3 tile = slot >> 3, at = slot & 7;
    snapshot.nodes.push_back(nodes[static_cast<std::size_t>(((tile.z * tiles + tile.y) * tiles + tile.x) * 512 +
                                                            (at.z * 8 + at.y) * 8 + at.x)]);
  }
  return snapshot;
}

} // namespace brickfield::test
