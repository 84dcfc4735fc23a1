// Timestamp queries, four frames deep so that reading an old frame never waits; the clock on software rasterizers.
#include "gpu/timer.h"

#include "core/error.h"

namespace brickfield {

FrameTimers::FrameTimers(const ContextInfo& info) : useClock_(info.isSoftware) {}

FrameTimers::~FrameTimers() {
  for (const std::vector<Sample>& samples : frames_)
    for (const Sample& sample : samples)
      if (sample.queries[0]) glDeleteQueries(2, sample.queries.data());
  if (!freeQueries_.empty()) glDeleteQueries(static_cast<GLsizei>(freeQueries_.size()), freeQueries_.data());
}

GLuint FrameTimers::takeQuery() {
  if (freeQueries_.empty()) {
    GLuint query = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &query);
    return query;
  }
  const GLuint query = freeQueries_.back();
  freeQueries_.pop_back();
  return query;
}

void FrameTimers::requireClosed() const {
  if (depth_ != 0) throw Failure("timers: a scope is still open");
}

void FrameTimers::beginFrame() {
  requireClosed();
  current_ = (current_ + 1) % kFrames;
  for (const Sample& sample : frames_[current_])
    if (sample.queries[0]) freeQueries_.insert(freeQueries_.end(), sample.queries.begin(), sample.queries.end());
  frames_[current_].clear();
}

FrameTimers::Scope::Scope(FrameTimers& timers, std::string_view name) : timers_(timers.enabled_ ? &timers : nullptr) {
  if (!timers_) return;
  std::vector<Sample>& samples = timers.frames_[timers.current_];
  index_ = samples.size();
  Sample& sample = samples.emplace_back();
  sample.name = name;
  sample.depth = timers.depth_++;
  if (timers.useClock_) {
    glFinish(); // Work issued before must not count.
  } else {
    sample.queries = {timers.takeQuery(), timers.takeQuery()};
    glQueryCounter(sample.queries[0], GL_TIMESTAMP);
  }
  sample.start = std::chrono::steady_clock::now();
}

FrameTimers::Scope::~Scope() {
  if (!timers_) return;
  --timers_->depth_;
  Sample& sample = timers_->frames_[timers_->current_][index_];
  if (timers_->useClock_) glFinish();
  sample.recordMilliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - sample.start).count();
  if (timers_->useClock_)
    sample.milliseconds = sample.recordMilliseconds;
  else
    glQueryCounter(sample.queries[1], GL_TIMESTAMP);
}

std::vector<PassTime> FrameTimers::collect(std::vector<Sample>& samples) {
  std::vector<PassTime> times;
  for (Sample& sample : samples) {
    if (sample.milliseconds < 0) {
      GLuint64 begin = 0, end = 0;
      glGetQueryObjectui64v(sample.queries[0], GL_QUERY_RESULT, &begin);
      glGetQueryObjectui64v(sample.queries[1], GL_QUERY_RESULT, &end);
      constexpr double kMillisecondsPerNanosecond = 1e-6;
      sample.milliseconds = end > begin ? static_cast<double>(end - begin) * kMillisecondsPerNanosecond : 0.0;
    }
    times.push_back({sample.name, sample.milliseconds, sample.depth, sample.recordMilliseconds});
  }
  return times;
}

std::vector<PassTime> FrameTimers::results() {
  requireClosed();
  return collect(frames_[current_]);
}

std::vector<PassTime> FrameTimers::finishedResults() {
  for (std::size_t age = 1; age < kFrames; ++age) {
    std::vector<Sample>& samples = frames_[(current_ + kFrames - age) % kFrames];
    if (samples.empty()) continue;
    bool arrived = true;
    for (const Sample& sample : samples) {
      if (sample.milliseconds >= 0) continue;
      GLuint available = GL_FALSE;
      glGetQueryObjectuiv(sample.queries[1], GL_QUERY_RESULT_AVAILABLE, &available);
      arrived = arrived && available;
    }
    if (arrived) return collect(samples);
  }
  return {};
}

} // namespace brickfield
