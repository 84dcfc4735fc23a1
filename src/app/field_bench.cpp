// The passes of both methods, in the renderer's order.
#include "app/field_bench.h"

#include <algorithm>
#include <optional>

#include "app/frame_medians.h"
#include "app/session.h"

namespace brickfield {

double FieldTimes::of(std::string_view pass) const {
  for (const PassTime& time : passes)
    if (time.name == pass) return time.milliseconds;
  return 0;
}

FieldBench::FieldBench(const ContextInfo& info, const Scene& scene, const SceneFields& fields)
    : scene_(scene),
      resident_(scene, fields),
      triangles_(scene, fields, resident_),
      hierarchy_(scene),
      shaders_(findShaderRoot()),
      timers_(info),
      targets_({4, 4}),
      counters_("counters", 64),
      deform_(shaders_),
      gather_(shaders_),
      pseudonormals_(shaders_),
      clear_(shaders_),
      splat_(shaders_),
      candidates_(shaders_),
      resolve_(shaders_),
      refit_(shaders_),
      voxelize_(shaders_),
      flood_(shaders_),
      rays_(shaders_) {}

template <typename Record>
void FieldBench::timeUpdate(const Record& record) {
  if (arePassesApart_) return record();
  const auto timer = timers_.scope("update");
  record();
}

template <typename Record>
void FieldBench::timePass(const char* name, GLbitfield barriers, const Record& record) {
  std::optional<FrameTimers::Scope> timer;
  if (arePassesApart_) timer.emplace(timers_, name);
  record();
  if (barriers) glMemoryBarrier(barriers);
}

void FieldBench::recordExact(ExactField& exact) {
  FrameContext context{resident_, targets_, visible_, counters_, none_, none_};
  context.worldTriangles = &triangles_;
  timePass("deform", GL_SHADER_STORAGE_BARRIER_BIT, [&] { deform_.record(context); });
  timePass("field_clear", 0, [&] { clear_.record(exact); });
  timePass("world_triangles", GL_SHADER_STORAGE_BARRIER_BIT, [&] { gather_.record(context); });
  timePass("world_pseudonormals", 0, [&] { pseudonormals_.record(context); });
  timePass("field_splat", GL_SHADER_STORAGE_BARRIER_BIT, [&] { splat_.record(exact, triangles_.triangles()); });
  timePass("field_candidates", GL_SHADER_STORAGE_BARRIER_BIT,
           [&] { candidates_.record(exact, triangles_.triangles()); });
  timePass("field_resolve", GL_TEXTURE_FETCH_BARRIER_BIT,
           [&] { resolve_.record(exact, triangles_.triangles(), resident_); });
}

void FieldBench::recordRtsdf(RtsdfField& field) {
  FrameContext context{resident_, targets_, visible_, counters_, none_, none_};
  context.worldTriangles = &triangles_;
  timePass("deform", GL_SHADER_STORAGE_BARRIER_BIT, [&] { deform_.record(context); });
  timePass("world_triangles", GL_SHADER_STORAGE_BARRIER_BIT, [&] { gather_.record(context); });
  timePass("hierarchy_refit", GL_SHADER_STORAGE_BARRIER_BIT,
           [&] { refit_.record(hierarchy_.hierarchy(), triangles_.triangles()); });
  timePass("rtsdf_voxelize", GL_SHADER_STORAGE_BARRIER_BIT,
           [&] { voxelize_.record(field, triangles_.triangles(), triangles_.triangleCount()); });
  timePass("rtsdf_jump_flood", GL_ALL_BARRIER_BITS, [&] { flood_.record(field); });
  timePass("rtsdf_rays", GL_ALL_BARRIER_BITS,
           [&] { rays_.record(field, hierarchy_.hierarchy(), triangles_.triangles()); });
}

template <typename Record>
FieldTimes FieldBench::timeFrames(int frames, const Record& record) {
  int frame = warmUp([&](int number) {
    throwIfInterrupted();
    timers_.beginFrame();
    record(number);
    glFinish();
  });
  FrameMedians whole, apart;
  std::vector<double> plans;
  for (const int end = frame + 2 * frames; frame < end; ++frame) {
    throwIfInterrupted();
    timers_.beginFrame();
    arePassesApart_ = !arePassesApart_;
    plans.push_back(record(frame));
    (arePassesApart_ ? apart : whole).add(timers_.results());
  }
  FieldTimes times;
  times.passes = apart.passes();
  times.milliseconds = whole.sumMilliseconds();
  times.planMilliseconds = medianOf(plans);
  return times;
}

FieldTimes FieldBench::timeExact(const FieldShape& shape, const PoseOfFrame& poseOf, int frames) {
  WorldField field(shape);
  const glm::dvec3 eye(poseOf(0).boundsWorld.center());
  std::uint32_t gathered = 0;
  FieldTimes times = timeFrames(frames, [&](int frame) {
    const Pose pose = poseOf(frame);
    const Stopwatch plan;
    resident_.setPose(scene_, pose);
    const bool isNew = triangles_.setPose(scene_, pose, field.anchorFor(pose.boundsWorld, eye));
    field.update(triangles_, resident_, isNew, eye);
    const double planMilliseconds = plan.milliseconds();
    gathered = triangles_.triangleChunks() * shared::GATHER_TRIANGLES;
    timeUpdate([&] { recordExact(field.exact()); });
    triangles_.settle();
    return planMilliseconds;
  });
  times.tiles = {field.exact().lengthOf(ExactField::List::Keys), field.exact().lengthOf(ExactField::List::Candidates),
                 field.exact().lengthOf(ExactField::List::Values)};
  times.gathered = std::min(gathered, triangles_.triangleCount());
  times.drawn = std::min(field.exact().splatCount() * shared::GATHER_TRIANGLES, triangles_.triangleCount());
  times.sdfObjects = times.tiles.values > 0 ? resident_.sdfInstanceCount() : 0;
  times.bytes = field.exact().bytes() + NearestPoints::bytesFor(resident_) + triangles_.bytes();
  return times;
}

FieldTimes FieldBench::timeRtsdf(const RtsdfSettings& settings, const PoseOfFrame& poseOf, int frames) {
  RtsdfField field(settings);
  const Box boundsWorld = poseOf(0).boundsWorld;
  const glm::dvec3 anchor(boundsWorld.center());
  FieldTimes times = timeFrames(frames, [&](int frame) {
    const Pose pose = poseOf(frame);
    const Stopwatch plan;
    resident_.setPose(scene_, pose);
    const bool isNew = triangles_.setPose(scene_, pose, anchor);
    hierarchy_.update(triangles_, isNew || frame == 0);
    field.place({boundsWorld.min - glm::vec3(anchor), boundsWorld.max - glm::vec3(anchor)});
    field.reserveTriangles(triangles_.triangleCount());
    const double planMilliseconds = plan.milliseconds();
    timeUpdate([&] { recordRtsdf(field); });
    triangles_.settle();
    return planMilliseconds;
  });
  times.bytes = field.bytes() + triangles_.bytes() + hierarchy_.bytes();
  return times;
}

} // namespace brickfield
