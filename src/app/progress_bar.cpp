// Draws at most ten times a second, and always when a stage begins or ends.
#include "app/progress_bar.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

#include "app/session.h"

namespace brickfield {

namespace {
constexpr auto kLeastInterval = std::chrono::milliseconds(100);
constexpr int kBarColumns = 32;
constexpr const char* kReturnAndEraseLine = "\r\x1b[K";
} // namespace

std::string progressLine(std::string_view stage, std::uint64_t done, std::uint64_t total, int columns) {
  const double share = total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const int filled = static_cast<int>(share * columns);
  return fmt::format("[{:#>{}}{:->{}}] {:3.0f} %  {}", "", filled, "", columns - filled, share * 100.0, stage);
}

ProgressBar::ProgressBar() : isTerminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() { wipe(); }

Progress ProgressBar::progress() {
  Progress progress;
  progress.cancelled = &isInterrupted();
  if (isTerminal_)
    progress.report = [this](std::string_view stage, std::uint64_t done, std::uint64_t total) {
      show(stage, done, total);
    };
  return progress;
}

void ProgressBar::show(std::string_view stage, std::uint64_t done, std::uint64_t total) {
  const auto now = std::chrono::steady_clock::now();
  const bool isNewStage = stage != stage_;
  if (!isNewStage && done < total && now - drawnAt_ < kLeastInterval) return;
  stage_ = stage;
  drawnAt_ = now;
  isDrawn_ = true;
  fmt::print(stderr, "{}{}", kReturnAndEraseLine, progressLine(stage, done, total, kBarColumns));
  std::fflush(stderr);
}

void ProgressBar::wipe() {
  if (!isDrawn_) return;
  fmt::print(stderr, "{}", kReturnAndEraseLine);
  std::fflush(stderr);
  isDrawn_ = false;
}

} // namespace brickfield
