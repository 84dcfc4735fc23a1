// Times of a frame's passes, and groups for graphics debuggers. On hardware by timestamp queries; on a software
// rasterizer, whose queries do not cover its threads' work, by glFinish and the clock.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/context.h"
#include "gpu/gl.h"

namespace brickfield {

struct PassTime {
  std::string name;
  double milliseconds = 0;
  int depth = 0; ///< 0 for outermost scopes, whose times add up
  /// Of the processor, from when the scope opened to when it closed; on a software rasterizer the same as the other.
  double recordMilliseconds = 0;
};

class FrameTimers {
public:
  explicit FrameTimers(const ContextInfo& info);
  ~FrameTimers();
  FrameTimers(FrameTimers&&) = delete;

  /// While disabled, scopes cost nothing and leave no results.
  void setEnabled(bool enabled) { enabled_ = enabled; }
  /// Starts a frame: what scopes record from now on replaces the frame four before. error Failure if a scope is open
  void beginFrame();

  /// Times what is issued until it is destroyed; scopes nest.
  class [[nodiscard]] Scope {
  public:
    Scope(FrameTimers& timers, std::string_view name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    FrameTimers* timers_;
    std::size_t index_ = 0;
  };
  Scope scope(std::string_view name) { return Scope(*this, name); }

  /// The scopes of the current frame in the order they opened; waits for the GPU. All must be closed.
  std::vector<PassTime> results();
  /// The same for the newest earlier frame whose times have arrived, without waiting; empty if none has.
  std::vector<PassTime> finishedResults();

private:
  struct Sample {
    std::string name;
    int depth = 0;
    std::array<GLuint, 2> queries{};
    std::chrono::steady_clock::time_point start;
    double milliseconds = -1;
    double recordMilliseconds = 0;
  };
  static constexpr std::size_t kFrames = 4;

  GLuint takeQuery();
  void requireClosed() const;
  static std::vector<PassTime> collect(std::vector<Sample>& samples);

  bool useClock_;
  bool enabled_ = true;
  int depth_ = 0;
  std::size_t current_ = 0;
  std::array<std::vector<Sample>, kFrames> frames_;
  std::vector<GLuint> freeQueries_;
};

/// Names what is issued until it is destroyed, for RenderDoc, Nsight and apitrace.
class [[nodiscard]] DebugGroup {
public:
  explicit DebugGroup(std::string_view label) {
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(label.size()), label.data());
  }
  ~DebugGroup() { glPopDebugGroup(); }
  DebugGroup(const DebugGroup&) = delete;
  DebugGroup& operator=(const DebugGroup&) = delete;
};

} // namespace brickfield
