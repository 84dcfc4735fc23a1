// Content hashes (XXH3, 128 bits): names of cache entries and checksums of file chunks. Not cryptographic.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace brickfield {

struct Hash128 {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  auto operator<=>(const Hash128&) const = default;
  /// 32 lower-case hexadecimal digits.
  std::string text() const;
};

/// Streams values into one hash. Vectors are hashed with their length, so that neighbours cannot run together.
class Hasher {
public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  Hasher& add(std::span<const std::byte> bytes);
  Hasher& add(std::string_view text);
  template <typename Value>
  Hasher& add(const Value& value) requires(std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    return add(std::as_bytes(std::span(&value, 1)));
  }
  /// Element type must have no padding bytes.
  template <typename Element>
  Hasher& addArray(const std::vector<Element>& values) requires(std::is_trivially_copyable_v<Element>) {
    add(static_cast<std::uint64_t>(values.size()));
    return add(std::as_bytes(std::span(values)));
  }
  Hash128 finish() const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Hash of one run of bytes.
std::uint64_t hash64(std::span<const std::byte> bytes);

} // namespace brickfield
