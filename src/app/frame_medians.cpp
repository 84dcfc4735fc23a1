// A map by names, and the order beside it.
#include "app/frame_medians.h"

#include <algorithm>

#include "core/error.h"

namespace brickfield {

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void FrameMedians::add(const std::vector<PassTime>& passes) {
  if (passes.empty()) throw Failure("the GPU gave no times: it may have been reset");
  double sum = 0;
  for (const PassTime& pass : passes) {
    if (pass.depth > 0) continue; // a part of another
    if (!samples_.contains(pass.name)) order_.push_back(pass.name);
    samples_[pass.name].push_back(pass.milliseconds);
    recordings_[pass.name].push_back(pass.recordMilliseconds);
    sum += pass.milliseconds;
  }
  sums_.push_back(sum);
}

std::vector<PassTime> FrameMedians::passes() const {
  std::vector<PassTime> medians;
  for (const std::string& name : order_)
    medians.push_back({name, medianOf(samples_.at(name)), 0, medianOf(recordings_.at(name))});
  return medians;
}

} // namespace brickfield
