// Medians of times over frames.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "gpu/timer.h"

namespace brickfield {

double medianOf(std::vector<double> values); ///< the upper middle one; 0 of none

/// Collects the passes' times of one frame after the other.
class FrameMedians {
public:
  /// error Failure: a driver that lost its device gives none
  void add(const std::vector<PassTime>& passes);
  std::vector<PassTime> passes() const;                      ///< in the order in which they first came
  double sumMilliseconds() const { return medianOf(sums_); } ///< of the frames' sums

private:
  std::vector<std::string> order_;
  std::map<std::string, std::vector<double>> samples_, recordings_;
  std::vector<double> sums_;
};

/// Runs from when it is made.
class Stopwatch {
public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Draws frames 0, 1, ... until a GPU that was idle has its clock up: for half a second, and two at least, so
/// that the first, which makes everything, is none of those that count.
///
/// draw     of a frame's number; ends by waiting for the GPU
/// returns  the number of the next frame
/// error    Cancelled
template <typename Draw>
int warmUp(const Draw& draw) {
  constexpr double kMilliseconds = 500; // after 100 an H200 was seen at a third of its clock
  constexpr int kMostFrames = 1000;
  const Stopwatch stopwatch;
  int frame = 0;
  for (; frame < 2 || (stopwatch.milliseconds() < kMilliseconds && frame < kMostFrames); ++frame) draw(frame);
  return frame;
}

} // namespace brickfield
