// Linux keeps the highest resident size of a process and begins anew when 5 is written to clear_refs.
#include "app/peak_memory.h"

#include <fstream>
#include <string>

#include <malloc.h>

namespace brickfield {

namespace {

std::optional<std::uint64_t> statusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return std::stoull(line.substr(key.size())) * 1024;
  return {};
}

} // namespace

PeakMemory::PeakMemory() {
  malloc_trim(0); // what earlier work freed is no memory of this one
  std::ofstream clear("/proc/self/clear_refs");
  clear << "5" << std::flush;
  if (clear) start_ = statusBytes("VmRSS:");
}

std::optional<std::uint64_t> PeakMemory::bytes() const {
  const std::optional<std::uint64_t> peak = statusBytes("VmHWM:");
  if (!start_ || !peak) return {};
  return *peak > *start_ ? *peak - *start_ : 0;
}

} // namespace brickfield
