// How much memory a bake may take: what --memory says, else most of what this process may have.
#pragma once

#include <cstdint>
#include <string>

namespace brickfield {

/// "800MiB", "1.5GiB": at least 1 MiB. error BadInput that names the flag
std::uint64_t parseMemory(const std::string& flag, const std::string& text);

/// Four fifths of the machine's memory, or of the control group's limit where that is lower.
std::uint64_t defaultMemoryBytes();

} // namespace brickfield
