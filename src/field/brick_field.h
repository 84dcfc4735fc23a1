// BrickField: the signed distance of one object in sparse bricks, on the CPU. It is what a bake makes, what a .bricks
// file holds and what the atlas uploads. It does no baking and no GL.
//
// Layout of a level, seen along one axis (cell = voxel, sample = grid point, | = brick border):
//
//   sample  0 1 2 3 4 5 6 7
//           |-------------|-------------|        a brick owns 7 cells and stores 8 samples;
//                         0 1 2 3 4 5 6 7        the shared border sample is stored by both,
//                                                so trilinear filtering never leaves a brick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/hash.h"
#include "core/math.h"

namespace brickfield {

inline constexpr int kBrickSamples = 8;                                                 // samples along a brick's edge
inline constexpr int kBrickCells = kBrickSamples - 1;                                   // voxels along a brick's edge
inline constexpr int kBrickSampleCount = kBrickSamples * kBrickSamples * kBrickSamples; // samples of a brick

enum class DistanceFormat : std::uint32_t { R8Snorm = 0, R16Snorm = 1 };
inline std::size_t bytesPerSample(DistanceFormat format) { return format == DistanceFormat::R8Snorm ? 1 : 2; }

/// One indirection cell covers one brick. Either the index of a brick of its level, or nothing but a bound: the sign
/// and a distance in voxels of this level that no point of the cell has a surface nearer than. bits  31 empty, 30
/// inside (only where empty), 15..0 bound in 1/16 voxel, rounded down
struct IndirectionCell {
  std::uint32_t bits = 0;

  static constexpr std::uint32_t kEmptyBit = 1u << 31;
  static constexpr std::uint32_t kInsideBit = 1u << 30;
  static constexpr float kBoundStepsPerVoxel = 16.0f;

  static IndirectionCell brick(std::uint32_t brickIndex) { return {brickIndex}; }
  static IndirectionCell empty(bool inside, float boundVoxels);
  bool isEmpty() const { return bits & kEmptyBit; }
  bool isInside() const { return bits & kInsideBit; }
  std::uint32_t brickIndex() const { return bits; }
  float boundVoxels() const { return static_cast<float>(bits & 0xffffu) / kBoundStepsPerVoxel; }
};

/// One resolution of the field. Sample (i,j,k) of brick (a,b,c) lies at
/// originObject + voxelSizeObject * (7 * (a,b,c) + (i,j,k)). Arrays over bricks hold 512 samples a brick, i fastest.
struct BrickLevel {
  float voxelSizeObject = 0; ///< metres of object space along a voxel's edge
  glm::ivec3 brickCounts{0}; ///< bricks along each axis; indirection holds their product, x fastest
  float rangeVoxels = 4;     ///< stored value 1.0 stands for this many voxels; larger distances are clamped
  DistanceFormat format = DistanceFormat::R8Snorm;
  std::vector<std::uint32_t> indirection; ///< IndirectionCell::bits
  std::vector<std::byte> distances;       ///< SNORM, little-endian, negative inside
  // Surface attributes at the closest surface point; all empty, or one value a sample (emission may be empty alone).
  std::vector<std::uint32_t> baseColor; ///< RGBA8, sRGB transfer on RGB; alpha is coverage
  std::vector<std::uint32_t>
      material; ///< RGBA8: metallic, roughness, occlusion; unlit (0 or 255) or a card (card_crossing.h)
  std::vector<std::uint32_t> emission; ///< RGB9E5, linear radiance

  std::uint32_t brickCount() const {
    return static_cast<std::uint32_t>(distances.size() / (bytesPerSample(format) * kBrickSampleCount));
  }
  std::size_t cellIndex(glm::ivec3 brick) const {
    return static_cast<std::size_t>((brick.z * brickCounts.y + brick.y)) * static_cast<std::size_t>(brickCounts.x) +
           static_cast<std::size_t>(brick.x);
  }
};

/// Parts of closed solids that are thinner than a voxel of the finest level: no samples show them as they are.
struct ThinParts {
  static constexpr std::uint16_t kWhole = 10000;
  std::uint16_t perTenThousand = 0; ///< share of the closed surface that bounds them
  std::uint16_t resolution = 0;     ///< voxels along the longest side that would show them; 0: the field's own do

  bool operator==(const ThinParts&) const = default;
};

/// The field of one object; levels finest first, each with twice the voxel of the one before. The coarsest level has
/// every brick and a range that clamps nothing.
struct BrickField {
  Box boundsObject;          ///< what is traced: the surface and one voxel around it
  glm::vec3 originObject{0}; ///< sample 0 of every level
  std::vector<BrickLevel> levels;
  Hash128 sourceHash; ///< of mesh and settings, see bakers/bake_cache.h
  ThinParts thinParts;
};

inline std::int32_t largestCode(DistanceFormat format) { return format == DistanceFormat::R8Snorm ? 127 : 32767; }

/// SNORM code of a distance in units of the range, and back. Zero is never made of a negative distance: the code -1 is
/// taken instead, because the sign must survive.
inline std::int32_t encodeDistance(float distanceVoxels, float rangeVoxels, DistanceFormat format) {
  const float below = distanceVoxels / rangeVoxels;
  const float unit = below < 1.0f ? below : 1.0f; // NaN too: nothing is known there, so nothing is solid
  const float value = (unit > -1.0f ? unit : -1.0f) * static_cast<float>(largestCode(format));
  // As std::lround, halves away from zero, of what is small; that is a call a sample.
  const auto whole = static_cast<std::int32_t>(value);
  const float rest = value - static_cast<float>(whole); // exact
  const std::int32_t code = whole + (rest >= 0.5f ? 1 : 0) - (rest <= -0.5f ? 1 : 0);
  return code - ((code == 0) & (distanceVoxels < 0.0f) ? 1 : 0);
}
float decodeDistance(std::int32_t code, float rangeVoxels, DistanceFormat format);

/// Distance in voxels of one stored sample.
float storedDistance(const BrickLevel& level, std::uint32_t brickIndex, glm::ivec3 sample);

/// Signed distance from a point to the surface stored in one level.
///
/// pointObject metres in object space, finite; outside the grid it is clamped to it
/// returns     metres, negative inside; in empty cells the conservative bound with its sign
/// cost        one indirection read, eight distance reads
/// source      trilinear reconstruction; Hart 1996 for why the bound lets a ray step by it
/// proved by   tests/unit/field/brick_field_test.cpp
float sampleDistance(const BrickField& field, std::size_t level, glm::vec3 pointObject);

/// First crossing from outside to inside along a ray, by sphere tracing and bisection: the CPU twin of
/// shaders/lib/brick_trace.glsl.
///
/// direction  any length; the result is in units of it
/// returns    ray parameter in [tMin, tMax], or nothing
std::optional<float> traceField(const BrickField& field, std::size_t level, glm::vec3 originObject,
                                glm::vec3 directionObject, float tMin, float tMax);

/// Unit gradient of the field by central differences over one voxel; points outwards.
glm::vec3 fieldNormal(const BrickField& field, std::size_t level, glm::vec3 pointObject);

/// Checks every size, count and index; what a file or a caller by hand gave is safe to sample afterwards.
/// returns  empty if sound, else what is wrong
std::string validateField(const BrickField& field);

/// Bytes held by all arrays of the field.
std::size_t fieldBytes(const BrickField& field);

/// Pack and unpack of the attribute encodings; twins of shaders/lib/packing.glsl.
std::uint32_t packRgba8(glm::vec4 unit);
glm::vec4 unpackRgba8(std::uint32_t packed);
std::uint32_t packRgb9e5(glm::vec3 radiance);
glm::vec3 unpackRgb9e5(std::uint32_t packed);

} // namespace brickfield
