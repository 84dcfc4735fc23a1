// How long work reports and how it is cancelled. Rooms below `app` never print.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

namespace brickfield {

/// What a long computation calls now and then. Both members may be left empty.
struct Progress {
  /// stage what is being done ("bake Dragon"); done, total in any unit, done <= total. May be called from any thread,
  /// but never from two at a time.
  std::function<void(std::string_view stage, std::uint64_t done, std::uint64_t total)> report;
  /// When it turns true the computation throws Cancelled at the next opportunity.
  const std::atomic<bool>* cancelled = nullptr;

  bool isCancelled() const { return cancelled && cancelled->load(std::memory_order_relaxed); }
};

} // namespace brickfield
