// An idle GPU clocks down, so each case is run for a tenth of a second before it is timed.
#include "app/field_bench.h"

#include <algorithm>
#include <chrono>
#include <map>

#include <glm/gtc/matrix_transform.hpp>

#include "app/session.h"
#include "core/error.h"

namespace brickfield {

namespace {

constexpr double kWarmUpSeconds = 0.1;
constexpr float kTurn = 6.2831853f;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

Mesh torusMesh(float radius, float tube, std::uint32_t segments, std::uint32_t sides) {
  Primitive primitive;
  for (std::uint32_t s = 0; s < segments; ++s)
    for (std::uint32_t t = 0; t < sides; ++t) {
      const float a = kTurn * static_cast<float>(s) / static_cast<float>(segments);
      const float b = kTurn * static_cast<float>(t) / static_cast<float>(sides);
      const glm::vec3 outwards(std::cos(a), 0, -std::sin(a));
      const glm::vec3 normal = outwards * std::cos(b) + glm::vec3(0, std::sin(b), 0);
      primitive.positions.push_back(outwards * radius + normal * tube);
      primitive.normals.push_back(normal);
      const auto at = [&](std::uint32_t ds, std::uint32_t dt) {
        return (s + ds) % segments * sides + (t + dt) % sides;
      };
      for (const std::uint32_t index : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)})
        primitive.indices.push_back(index);
    }
  return {"Mover", {std::move(primitive)}, {}};
}

} // namespace

Scene withMover(const Scene& scene) {
  const glm::vec3 extent = poseScene(scene, {}).boundsWorld.extent();
  const float size = std::max({extent.x, extent.y, extent.z}) / 12;
  Scene result = scene;
  Node node;
  node.name = "Mover";
  node.mesh = static_cast<int>(result.meshes.size());
  result.meshes.push_back(torusMesh(size * 0.35f, size * 0.15f, 75, 40));
  result.scenes[static_cast<std::size_t>(std::max(result.defaultScene, 0))].nodes.push_back(
      static_cast<int>(result.nodes.size()));
  result.nodes.push_back(std::move(node));
  return result;
}

FieldBench::FieldBench(const ContextInfo& info, const Scene& scene, const SceneFields& fields)
    : scene_(scene),
      rest_(poseScene(scene, {})),
      resident_(scene, fields),
      triangles_(scene, fields, resident_),
      hierarchy_(scene),
      shaders_(findShaderRoot()),
      timers_(info),
      targets_({4, 4}),
      counters_("counters", 64),
      deform_(shaders_),
      gatherPass_(shaders_),
      splat_(shaders_),
      candidates_(shaders_),
      resolve_(shaders_),
      refit_(shaders_),
      voxelize_(shaders_),
      flood_(shaders_),
      rays_(shaders_) {}

Pose FieldBench::poseOf(FieldMotion motion, int frame) const {
  Pose pose = rest_;
  const glm::vec3 center = rest_.boundsWorld.center(), extent = rest_.boundsWorld.extent();
  const float angle = motion == FieldMotion::Nothing ? 0.0f : kTurn * static_cast<float>(frame % 60) / 60;
  for (PosedInstance& instance : pose.instances) {
    // Too little to change a figure, enough to be another place: every triangle is gathered and splatted anew.
    if (motion == FieldMotion::Everything && frame % 2) instance.worldFromObject[3].x += 1e-4f * extent.x;
    if (instance.node + 1 == static_cast<int>(scene_.nodes.size()))
      instance.worldFromObject = glm::translate(
          glm::mat4(1),
          center + 0.2f * extent * glm::vec3(std::cos(angle), 0.3f * std::sin(2 * angle), std::sin(angle)));
  }
  return pose;
}

void FieldBench::gather() {
  FrameContext context{resident_, targets_, visible_, counters_, none_, none_};
  context.worldTriangles = &triangles_;
  {
    const auto timer = timers_.scope("deform");
    deform_.record(context);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  const auto timer = timers_.scope("world_triangles");
  gatherPass_.record(context);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

template <typename Record>
FieldTimes FieldBench::timeFrames(int frames, const Record& record) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  int frame = 0;
  // At least two, so that the first, which makes everything, is none of those that count.
  for (; frame < 2 || (seconds() < kWarmUpSeconds && frame < 1000); ++frame) {
    throwIfInterrupted();
    timers_.beginFrame();
    record(frame);
    glFinish();
  }
  std::map<std::string, std::vector<double>> samples;
  std::vector<std::string> order;
  std::vector<double> sums;
  for (const int end = frame + frames; frame < end; ++frame) {
    throwIfInterrupted();
    timers_.beginFrame();
    record(frame);
    const std::vector<PassTime> passes = timers_.results();
    if (passes.empty()) throw Failure("the GPU gave no times: it may have been reset");
    double sum = 0;
    for (const PassTime& pass : passes) {
      if (!samples.contains(pass.name)) order.push_back(pass.name);
      samples[pass.name].push_back(pass.milliseconds);
      sum += pass.milliseconds;
    }
    sums.push_back(sum);
  }
  FieldTimes times;
  for (const std::string& name : order) times.passes.push_back({name, median(samples[name]), 0});
  times.sumMilliseconds = median(sums);
  return times;
}

FieldTimes FieldBench::timeExact(const FieldShape& shape, FieldMotion motion, int frames) {
  WorldField field(shape);
  const glm::dvec3 eye(rest_.boundsWorld.center());
  std::uint32_t gathered = 0;
  FieldTimes times = timeFrames(frames, [&](int frame) {
    const Pose pose = poseOf(motion, frame);
    resident_.setPose(scene_, pose);
    const bool isNew = triangles_.setPose(scene_, pose, field.anchorFor(rest_.boundsWorld, eye));
    field.update(triangles_, resident_, isNew, eye);
    gathered = triangles_.triangleChunks() * shared::GATHER_TRIANGLES;
    gather();
    {
      const auto timer = timers_.scope("field_splat");
      splat_.record(field.exact(), triangles_.triangles());
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    {
      const auto timer = timers_.scope("field_candidates");
      candidates_.record(field.exact(), triangles_.triangles());
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    {
      const auto timer = timers_.scope("field_resolve");
      resolve_.record(field.exact(), triangles_.triangles(), resident_);
      glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    triangles_.settle();
  });
  times.keyTiles = field.exact().lengthOf(ExactField::List::Keys);
  times.candidateTiles = field.exact().lengthOf(ExactField::List::Candidates);
  times.valueTiles = field.exact().lengthOf(ExactField::List::Values);
  times.gathered = std::min(gathered, triangles_.triangleCount());
  times.bytes = field.exact().bytes() + triangles_.bytes();
  return times;
}

FieldTimes FieldBench::timeRtsdf(const RtsdfSettings& settings, FieldMotion motion, int frames) {
  RtsdfField field(settings);
  const glm::dvec3 anchor(rest_.boundsWorld.center());
  FieldTimes times = timeFrames(frames, [&](int frame) {
    const Pose pose = poseOf(motion, frame);
    resident_.setPose(scene_, pose);
    const bool isNew = triangles_.setPose(scene_, pose, anchor);
    hierarchy_.update(triangles_, isNew || frame == 0);
    field.place({rest_.boundsWorld.min - glm::vec3(anchor), rest_.boundsWorld.max - glm::vec3(anchor)});
    field.reserveTriangles(triangles_.triangleCount());
    gather();
    {
      const auto timer = timers_.scope("hierarchy_refit");
      refit_.record(hierarchy_.hierarchy(), triangles_.triangles());
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    {
      const auto timer = timers_.scope("rtsdf_voxelize");
      voxelize_.record(field, triangles_.triangles(), triangles_.triangleCount());
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    {
      const auto timer = timers_.scope("rtsdf_jump_flood");
      flood_.record(field);
      glMemoryBarrier(GL_ALL_BARRIER_BITS);
    }
    {
      const auto timer = timers_.scope("rtsdf_rays");
      rays_.record(field, hierarchy_.hierarchy(), triangles_.triangles());
      glMemoryBarrier(GL_ALL_BARRIER_BITS);
    }
    triangles_.settle();
  });
  times.bytes = field.bytes() + triangles_.bytes() + hierarchy_.bytes();
  return times;
}

} // namespace brickfield
