// The most memory that a piece of work had resident at once.
#pragma once

#include <cstdint>
#include <optional>

namespace brickfield {

/// From its making on. Of the whole process, so other threads' memory counts too.
class PeakMemory {
public:
  PeakMemory();

  /// Bytes above those at the start; nothing where the system does not tell (it is Linux's /proc that does).
  std::optional<std::uint64_t> bytes() const;

private:
  std::optional<std::uint64_t> start_;
};

} // namespace brickfield
