// .bricks files that are cut, flipped, or made to harm: each is refused in one line that names file and place, and none
// makes the reader take more memory than its size can account for.
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include <gtest/gtest.h>
#include <zstd.h>

#include "core/error.h"
#include "core/hash.h"
#include "field/bricks_file.h"
#include "field/bricks_index.h"
#include "tests/unit/field/analytic_cases.h"

// The largest single allocation since it was last set to 0. Not inlined: g++ 12 would pair new with free and warn.
static std::atomic<std::size_t> largestAllocation{0};

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  std::size_t largest = largestAllocation;
  while (bytes > largest && !largestAllocation.compare_exchange_weak(largest, bytes)) {
  }
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace brickfield {
namespace {

using namespace test;
using Bytes = std::vector<std::byte>;

// Header with index of one level as bricks_index.h draws them.
constexpr std::size_t kFileBytesAt = 16, kThinPartsAt = 76, kLevelAt = 80, kCountsAt = kLevelAt + 4,
                      kBrickCountAt = kLevelAt + 24, kAttributesAt = kLevelAt + 28, kChunksAt = kLevelAt + 32,
                      kChunkBytes = 24;

const Bytes& smallFile() {
  static const Bytes bytes = [] {
    BrickField field = fieldOf(sphereBody(), 8, 8, 1);
    addAttributes(field, [](glm::vec3) { return SurfaceAttributes{}; });
    return encodeBricks(field);
  }();
  return bytes;
}

const Bytes& largerFile() {
  static const Bytes bytes = [] {
    BrickField field = fieldOf(torusBody(), 48, 8, 3);
    addAttributes(field, [](glm::vec3 p) {
      SurfaceAttributes a;
      a.baseColor = glm::vec4(glm::fract(p * 3.0f), 1);
      a.emission = glm::abs(p);
      return a;
    });
    return encodeBricks(field);
  }();
  return bytes;
}

// The message of the refusal; empty if the bytes were read.
std::string refusal(const Bytes& bytes) {
  try {
    decodeBricks(bytes, "hostile.bricks");
  } catch (const BadInput& error) {
    return error.what();
  }
  return {};
}

void expectRefused(const Bytes& bytes, const std::string& what) {
  const std::string message = refusal(bytes);
  ASSERT_FALSE(message.empty()) << what << " went unnoticed";
  ASSERT_EQ(message.find('\n'), std::string::npos) << what;
  ASSERT_EQ(message.rfind("hostile.bricks: ", 0), 0u) << message;
  const bool namesPlace = message.find("header") != std::string::npos || message.find("index") != std::string::npos ||
                          message.find("level ") != std::string::npos;
  ASSERT_TRUE(namesPlace) << what << ": " << message;
}

template <typename Value>
void patch(Bytes& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}
template <typename Value>
Value readAt(const Bytes& bytes, std::size_t at) {
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

// Gives header and index a checksum that fits what now stands in them.
void correctIndexChecksum(Bytes& bytes, std::size_t levels) {
  const std::size_t at = bricksIndexBytes(levels) - 8;
  patch(bytes, at, hash64(std::span<const std::byte>(bytes).first(at)));
}

TEST(BricksFileHostile, TruncatedAtEveryLength) {
  for (std::size_t length = 0; length < smallFile().size(); ++length)
    ASSERT_NO_FATAL_FAILURE(
        expectRefused({smallFile().begin(), smallFile().begin() + static_cast<std::ptrdiff_t>(length)},
                      "length " + std::to_string(length)));
  for (std::size_t i = 0; i < 256; ++i) {
    const std::size_t length = i * largerFile().size() / 256;
    ASSERT_NO_FATAL_FAILURE(
        expectRefused({largerFile().begin(), largerFile().begin() + static_cast<std::ptrdiff_t>(length)},
                      "length " + std::to_string(length)));
  }
}

TEST(BricksFileHostile, BytesAfterTheEnd) {
  Bytes longer = smallFile();
  longer.push_back(std::byte{0});
  expectRefused(longer, "a byte more");
  EXPECT_NE(refusal(longer).find("too long"), std::string::npos);
}

TEST(BricksFileHostile, EveryFlippedByteIsNoticed) {
  ASSERT_EQ(refusal(smallFile()), "");
  for (std::size_t i = 0; i < smallFile().size(); ++i)
    for (const unsigned mask : {1u << (i % 8), 0xffu}) {
      Bytes bytes = smallFile();
      bytes[i] ^= static_cast<std::byte>(mask);
      ASSERT_NO_FATAL_FAILURE(expectRefused(bytes, "byte " + std::to_string(i)));
    }
}

TEST(BricksFileHostile, RandomFlipsOfALargerFileAreNoticed) {
  ASSERT_EQ(refusal(largerFile()), "");
  Random random(12);
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = largerFile();
    const std::size_t at = random.bits() % bytes.size();
    bytes[at] ^= static_cast<std::byte>(1 + random.bits() % 255);
    ASSERT_NO_FATAL_FAILURE(expectRefused(bytes, "byte " + std::to_string(at)));
  }
}

TEST(BricksFileHostile, ChunkErrorsNameTheChunk) {
  Bytes bytes = smallFile();
  const auto distances = readAt<std::uint64_t>(bytes, kChunksAt + kChunkBytes);
  bytes[distances + 5] ^= std::byte{4};
  EXPECT_NE(refusal(bytes).find("level 0 distances: the checksum does not match"), std::string::npos) << refusal(bytes);
}

// Reads with the largest allocation that it took.
std::size_t allocationOf(const Bytes& bytes, std::string& message) {
  largestAllocation = 0;
  message = refusal(bytes);
  return largestAllocation;
}

TEST(BricksFileHostile, SmallFilesCannotClaimMuchMemory) {
  struct Claim {
    const char* name;
    glm::ivec3 counts;
    std::uint32_t bricks;
  };
  for (const Claim& claim :
       {Claim{"cells", {256, 256, 256}, 8}, Claim{"bricks", {256, 256, 256}, 1u << 24},
        Claim{"more bricks than cells", {2, 2, 2}, 0xffffffffu}, Claim{"huge axis", {0x7fffffff, 1, 1}, 8},
        Claim{"negative axes", {-1, -1, 8}, 8}, Claim{"product that overflows", {65536, 65536, 1}, 8},
        Claim{"1024 cubed", {1024, 1024, 1024}, 8}, Claim{"no cells", {0, 1, 1}, 0}}) {
    Bytes bytes = smallFile();
    patch(bytes, kCountsAt, claim.counts);
    patch(bytes, kBrickCountAt, claim.bricks);
    correctIndexChecksum(bytes, 1);
    std::string message;
    EXPECT_LT(allocationOf(bytes, message), std::size_t{1} << 20) << claim.name;
    EXPECT_EQ(message.find("checksum"), std::string::npos) << "the test must get past the checksum: " << message;
    expectRefused(bytes, claim.name);
  }
}

TEST(BricksFileHostile, NeitherCanTwoHundredBytes) {
  // Header, index and nothing else, where every chunk claims the whole rest.
  Bytes bytes(smallFile().begin(), smallFile().begin() + static_cast<std::ptrdiff_t>(bricksIndexBytes(1)));
  bytes.resize(bytes.size() + 40);
  patch(bytes, kFileBytesAt, std::uint64_t{bytes.size()});
  patch(bytes, kCountsAt, glm::ivec3(256));
  patch(bytes, kBrickCountAt, std::uint32_t{1} << 24);
  patch(bytes, kChunksAt, std::uint64_t{bricksIndexBytes(1)});
  patch(bytes, kChunksAt + 8, std::uint64_t{40});
  correctIndexChecksum(bytes, 1);
  std::string message;
  EXPECT_LT(allocationOf(bytes, message), std::size_t{1} << 20);
  EXPECT_NE(message.find("cannot hold"), std::string::npos) << message;
}

TEST(BricksFileHostile, AnyHeaderFieldMayHoldAnything) {
  // Every aligned word of header and index takes hostile values under a correct checksum. Some are harmless (the source
  // hash, thin parts, the range); the others must be refused, and none may take much memory or crash.
  const std::uint32_t values[] = {0u,          1u,          2u,          0x7fu,       0xffffu,
                                  0x10000u,    0x7fffffffu, 0x80000000u, 0xffffffffu, 0x7f800000u,
                                  0xff800000u, 0x7fc00000u, 0x00000001u, 0x7f7fffffu, 0x3f800000u};
  int refused = 0, accepted = 0;
  for (std::size_t at = 8; at + 8 < bricksIndexBytes(1); at += 4)
    for (const std::uint32_t value : values) {
      Bytes bytes = smallFile();
      if (readAt<std::uint32_t>(bytes, at) == value) continue;
      patch(bytes, at, value);
      correctIndexChecksum(bytes, 1);
      std::string message;
      ASSERT_LT(allocationOf(bytes, message), std::size_t{16} << 20) << at;
      const bool isHash = at >= 24 && at < 40, isShape = at >= 40 && at < kThinPartsAt,
                 isThinParts = at == kThinPartsAt, isFloat = at == kLevelAt || at == kLevelAt + 16;
      if (message.empty()) {
        ++accepted;
        ASSERT_TRUE(isHash || isShape || isThinParts || isFloat)
            << "word at " << at << " with " << value << " went unnoticed";
      } else {
        ++refused;
        ASSERT_EQ(message.rfind("hostile.bricks: ", 0), 0u) << message;
        ASSERT_FALSE(isHash) << message;
      }
    }
  EXPECT_GT(refused, 400);
  EXPECT_GT(accepted, 50);
}

// Replaces one chunk of the small file by other bytes, with all sizes, offsets and checksums right.
Bytes withChunk(ChunkKind kind, const Bytes& packed) {
  Bytes bytes = smallFile();
  const std::size_t entry = kChunksAt + static_cast<std::size_t>(kind) * kChunkBytes;
  const auto at = readAt<std::uint64_t>(bytes, entry), old = readAt<std::uint64_t>(bytes, entry + 8);
  const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(old));
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), packed.begin(), packed.end());
  patch(bytes, entry + 8, std::uint64_t{packed.size()});
  patch(bytes, entry + 16, hash64(packed));
  for (std::size_t later = entry + kChunkBytes; later < kChunksAt + 4 * kChunkBytes; later += kChunkBytes)
    patch(bytes, later, readAt<std::uint64_t>(bytes, later) + packed.size() - old);
  patch(bytes, kFileBytesAt, std::uint64_t{bytes.size()});
  correctIndexChecksum(bytes, 1);
  return bytes;
}
Bytes withDistances(const Bytes& packed) { return withChunk(ChunkKind::Distances, packed); }

Bytes compressed(const Bytes& content, bool withSize = true) {
  Bytes packed(ZSTD_compressBound(content.size()));
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, withSize ? 1 : 0);
  packed.resize(ZSTD_compress2(context, packed.data(), packed.size(), content.data(), content.size()));
  ZSTD_freeCCtx(context);
  return packed;
}

TEST(BricksFileHostile, ChunksThatUnpackToAnotherSize) {
  const BrickField field = decodeBricks(smallFile(), "small");
  const Bytes& distances = field.levels[0].distances;
  ASSERT_EQ(refusal(withDistances(compressed(distances))), "") << "the patched file itself is sound";
  const auto expectChunkRefused = [](const Bytes& packed, const char* what) {
    std::string message;
    const Bytes bytes = withDistances(packed);
    EXPECT_LT(allocationOf(bytes, message), std::size_t{1} << 20) << what;
    EXPECT_NE(message.find("level 0 distances"), std::string::npos) << what << ": " << message;
    EXPECT_EQ(message.find("checksum"), std::string::npos) << what << ": " << message;
  };
  expectChunkRefused(compressed(Bytes(std::size_t{1} << 26)), "a bomb of 64 MiB");
  expectChunkRefused(compressed(Bytes(distances.size() - 1)), "a byte less");
  expectChunkRefused(compressed(Bytes(distances.size() + 1)), "a byte more");
  expectChunkRefused(compressed(distances, false), "a frame that hides its size");
  expectChunkRefused({}, "no bytes");
  expectChunkRefused(Bytes(50), "no zstd");
  Bytes two = compressed(distances);
  const Bytes empty = compressed({});
  two.insert(two.end(), empty.begin(), empty.end());
  expectChunkRefused(two, "a second frame");
}

TEST(BricksFileHostile, DamageUnderCorrectChecksumsIsReadOrRefused) {
  // The compressed bytes themselves are hostile: whatever zstd and validateField let pass must be safe to sample.
  const BrickField field = decodeBricks(smallFile(), "small");
  const Bytes packed = compressed(field.levels[0].distances);
  Random random(5);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    Bytes hostile = packed;
    for (std::uint32_t flips = 1 + random.bits() % 3; flips > 0; --flips)
      hostile[random.bits() % hostile.size()] ^= static_cast<std::byte>(1 + random.bits() % 255);
    const Bytes bytes = withDistances(hostile);
    std::string message;
    ASSERT_LT(allocationOf(bytes, message), std::size_t{4} << 20);
    if (!message.empty()) {
      ++refused;
      continue;
    }
    const BrickField read = decodeBricks(bytes, "hostile");
    ASSERT_TRUE(std::isfinite(sampleDistance(read, 0, random.in(read.boundsObject))));
    traceField(read, 0, random.in(read.boundsObject), random.direction(), 0, 10);
  }
  EXPECT_GT(refused, 100);
}

TEST(BricksFileHostile, FieldsThatCannotBeSampled) {
  // Sound as a file, unsound as a field.
  const std::vector<std::uint32_t> cells = decodeBricks(smallFile(), "small").levels[0].indirection;
  const auto withCell = [&](std::uint32_t cell) {
    std::vector<std::uint32_t> changed = cells;
    changed[3] = cell;
    const auto raw = std::as_bytes(std::span(changed));
    return withChunk(ChunkKind::Indirection, compressed(Bytes(raw.begin(), raw.end())));
  };
  ASSERT_EQ(refusal(withCell(cells[3])), "");
  for (const std::uint32_t cell : {8u, 0x7fffffffu, 0x80000000u, 0xc000ffffu})
    EXPECT_NE(refusal(withCell(cell)).find("level 0: indirection cell 3"), std::string::npos)
        << refusal(withCell(cell));
  for (const float bad : {std::nanf(""), 0.0f, -1.0f, std::numeric_limits<float>::infinity()})
    for (const std::size_t at : {kLevelAt, kLevelAt + 16}) {
      Bytes bytes = smallFile();
      patch(bytes, at, bad);
      correctIndexChecksum(bytes, 1);
      expectRefused(bytes, "voxel size or range " + std::to_string(bad));
    }
}

TEST(BricksFileHostile, CountsAndChunksThatDoNotFit) {
  Bytes longer = smallFile();
  longer.push_back(std::byte{0});
  patch(longer, kFileBytesAt, std::uint64_t{longer.size()});
  correctIndexChecksum(longer, 1);
  expectRefused(longer, "a byte under no checksum");
  EXPECT_NE(refusal(longer).find("chunks end at"), std::string::npos) << refusal(longer);

  // The first chunk's size wraps around, so that the second "follows" it and all ends at the end of the file.
  Bytes wrapped = smallFile();
  const auto first = readAt<std::uint64_t>(wrapped, kChunksAt),
             third = readAt<std::uint64_t>(wrapped, kChunksAt + 2 * kChunkBytes);
  patch(wrapped, kChunksAt + 8, std::uint64_t{0} - 100);
  patch(wrapped, kChunksAt + kChunkBytes, first - 100);
  patch(wrapped, kChunksAt + kChunkBytes + 8, third - (first - 100));
  correctIndexChecksum(wrapped, 1);
  expectRefused(wrapped, "a size that wraps around");
  EXPECT_NE(refusal(wrapped).find("reach beyond"), std::string::npos) << refusal(wrapped);

  Bytes more = smallFile();
  patch(more, kBrickCountAt, std::uint32_t{9});
  correctIndexChecksum(more, 1);
  EXPECT_NE(refusal(more).find("9 bricks for 8 cells"), std::string::npos) << refusal(more);
  patch(more, kCountsAt, glm::ivec3(1024));
  correctIndexChecksum(more, 1);
  EXPECT_NE(refusal(more).find("1073741824 cells are more than"), std::string::npos) << refusal(more);
}

TEST(BricksFileHostile, AttributeBits) {
  for (const std::uint32_t bits : {0u, 2u, 3u, 4u, 5u, 0x80000001u}) {
    Bytes bytes = smallFile();
    patch(bytes, kAttributesAt, bits);
    correctIndexChecksum(bytes, 1);
    expectRefused(bytes, "attribute bits " + std::to_string(bits));
  }
}

} // namespace
} // namespace brickfield
