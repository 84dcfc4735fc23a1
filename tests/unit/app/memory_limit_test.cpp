// Amounts of memory from their texts, and a default that fits the machine.
#include "app/memory_limit.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"

namespace brickfield {
namespace {

TEST(ParseMemory, TakesMebibytesAndGibibytes) {
  EXPECT_EQ(parseMemory("--memory", "1MiB"), std::uint64_t{1} << 20);
  EXPECT_EQ(parseMemory("--memory", "1.5GiB"), std::uint64_t{3} << 29);
  EXPECT_EQ(parseMemory("--memory", "0.5GiB"), std::uint64_t{1} << 29);
  EXPECT_EQ(parseMemory("--memory", "4096MiB"), std::uint64_t{1} << 32);
}

TEST(ParseMemory, RefusesAllElse) {
  for (const char* text : {"", "4", "4GB", "4 GiB", "GiB", "MiB", "-1GiB", "0MiB", "0.5MiB", "nanGiB", "infGiB",
                           "1e30GiB", "4gib", "4GiBs", "0x4GiB"})
    EXPECT_THROW(parseMemory("--memory", text), BadInput) << text;
}

TEST(DefaultMemory, IsMostOfTheMachineAtMost) {
  const auto physical =
      static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  EXPECT_GT(defaultMemoryBytes(), std::uint64_t{64} << 20);
  EXPECT_LE(defaultMemoryBytes(), physical / 5 * 4);
}

} // namespace
} // namespace brickfield
