// Hashes: known value, streaming, and that neighbours do not run together.
#include "core/hash.h"

#include <string_view>

#include <gtest/gtest.h>

namespace brickfield::test {
namespace {

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

TEST(Hash, EmptyInputHasThePublishedValue) {
  // XXH3 of no bytes with seed 0, from the reference implementation's own tests: cache names must never move.
  EXPECT_EQ(Hasher().finish().text(), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(hash64({}), 0x2d06800538d394c2ull);
}

TEST(Hash, TextIsThirtyTwoDigits) { EXPECT_EQ((Hash128{0x1, 0xabc}).text(), "00000000000000010000000000000abc"); }

TEST(Hash, BytesStreamWithoutSeams) {
  EXPECT_EQ(Hasher().add(bytesOf("brick")).add(bytesOf("field")).finish(),
            Hasher().add(bytesOf("brickfield")).finish());
  EXPECT_NE(Hasher().add(bytesOf("brick")).finish(), Hasher().add(bytesOf("field")).finish());
}

TEST(Hash, LengthKeepsTextsApart) {
  const std::string_view ab = "ab", c = "c", a = "a", bc = "bc", none;
  EXPECT_NE(Hasher().add(ab).add(c).finish(), Hasher().add(a).add(bc).finish());
  EXPECT_NE(Hasher().add(none).add(a).finish(), Hasher().add(a).add(none).finish());
  EXPECT_NE(Hasher().add(none).finish(), Hasher().finish());
}

TEST(Hash, LengthKeepsArraysApart) {
  using Ints = std::vector<std::int32_t>;
  EXPECT_NE(Hasher().addArray(Ints{1, 2}).addArray(Ints{3}).finish(),
            Hasher().addArray(Ints{1}).addArray(Ints{2, 3}).finish());
  EXPECT_NE(Hasher().addArray(Ints{}).finish(), Hasher().finish());
  EXPECT_EQ(Hasher().addArray(Ints{1, 2}).finish(), Hasher().addArray(Ints{1, 2}).finish());
}

TEST(Hash, ValuesEnterWithAllTheirBytes) {
  EXPECT_NE(Hasher().add(1.0f).finish(), Hasher().add(1.0).finish());
  EXPECT_NE(Hasher().add(std::uint8_t{1}).finish(), Hasher().add(std::uint16_t{1}).finish());
}

TEST(Hash, FinishMayBeAskedAgainAndGoOn) {
  Hasher hasher;
  hasher.add(1);
  const Hash128 first = hasher.finish();
  EXPECT_EQ(hasher.finish(), first);
  EXPECT_EQ(hasher.add(2).finish(), Hasher().add(1).add(2).finish());
}

} // namespace
} // namespace brickfield::test
