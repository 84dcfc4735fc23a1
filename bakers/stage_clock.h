// Wall-clock seconds of the stages of a bake.
#pragma once

#include <chrono>

#include "bakers/bake.h"

namespace brickfield {

/// Adds the time from its making to its end to a stage.
class StageClock {
public:
  explicit StageClock(double& seconds) : seconds_(seconds) {}
  ~StageClock() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The result of `work`, its time added to a stage.
template <typename Work>
auto timed(double& seconds, const Work& work) {
  const StageClock clock(seconds);
  return work();
}

} // namespace brickfield
