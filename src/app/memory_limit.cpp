// The limit is read where Linux keeps it; containers see the whole machine elsewhere.
#include "app/memory_limit.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

std::uint64_t parseMemory(const std::string& flag, const std::string& text) {
  int exponent = 0;
  if (text.ends_with("MiB")) exponent = 20;
  if (text.ends_with("GiB")) exponent = 30;
  if (exponent == 0) throw BadInput(flag, fmt::format("\"{}\"", text), "is no number of MiB or GiB, such as 1.5GiB");
  const double number = parseNumber(flag, text.substr(0, text.size() - 3), -1e30, 1e30);
  const double bytes = std::ldexp(number, exponent), least = std::ldexp(1.0, 20), most = std::ldexp(1.0, 50);
  if (!(bytes >= least && bytes <= most))
    throw BadInput(flag, fmt::format("\"{}\"", text), "is not from 1 MiB to a million GiB");
  return static_cast<std::uint64_t>(bytes);
}

std::uint64_t defaultMemoryBytes() {
  std::uint64_t bytes = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES))) *
                        static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
  // Control groups of version 2 and 1; "max" and a missing file read as no number.
  for (const char* path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::uint64_t limit = 0;
    if (std::ifstream(path) >> limit && limit > 0) bytes = std::min(bytes, limit);
  }
  return bytes / 5 * 4;
}

} // namespace brickfield
