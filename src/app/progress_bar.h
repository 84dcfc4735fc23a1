// A bar on stderr for long work, where stderr is a terminal; silent elsewhere, so that scripts see only messages.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/progress.h"

namespace brickfield {

/// "[########--------]  50 %  bake Dragon", with `columns` signs between the brackets. total 0 counts as done.
std::string progressLine(std::string_view stage, std::uint64_t done, std::uint64_t total, int columns);

class ProgressBar {
public:
  ProgressBar();
  ~ProgressBar(); ///< wipes the bar
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// What a long computation is handed: it draws here and stops on Ctrl-C. Valid as long as the bar lives.
  Progress progress();

private:
  void show(std::string_view stage, std::uint64_t done, std::uint64_t total);
  void wipe();

  bool isTerminal_ = false;
  bool isDrawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point drawnAt_{};
};

} // namespace brickfield
