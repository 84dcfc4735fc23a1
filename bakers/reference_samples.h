// Random numbers of the reference: for every pixel, seed and purpose its own stratified points, each a function of its
// number alone, so that threads, passes and tiles change nothing. Inner header of the reference.
#pragma once

#include <cstdint>

#include "core/math.h"

namespace brickfield {

/// What a set of points is for: sets of different purpose are independent.
enum class SamplePurpose : std::uint32_t {
  Pixel = 0,
  Occlusion = 1,
  OcclusionLayer = 2,
  Mirror = 3,
  Light = 16,
  LightLayer = 1040
};

/// Well mixed bits of a counter (SplitMix64's finalizer, Steele et al. 2014).
std::uint64_t mixBits(std::uint64_t bits);

/// The stratified points of one pixel for one purpose.
///
/// Correlated multi-jitter (Kensler, "Correlated Multi-Jittered Sampling", 2013): of `count` points each column and row
/// of a grid of about square cells has its share, and so has each of `count` rows. Each single point is uniform over
/// the square whatever the count, so that every mean over points is unbiased.
class PixelSamples {
public:
  PixelSamples(glm::uvec2 pixel, std::uint64_t seed, int count);

  /// index    0 to count - 1; points of one index and different purposes are independent of each other
  /// purpose  plus a number below 1024 for lights
  /// returns  in [0,1)²
  /// proved by tests/oracle/bakers/reference_samples_test.cpp
  glm::vec2 point(int index, SamplePurpose purpose, std::uint32_t number = 0) const;
  int count() const { return count_; }
  /// Points of their own for what a mirrored ray meets.
  PixelSamples ofMirrored() const;

private:
  std::uint64_t pixelBits_;
  int count_;
};

/// Area-preserving map of the unit square to the unit disk that keeps neighbours together (Shirley and Chiu 1997).
glm::vec2 diskFromSquare(glm::vec2 square);

/// Two unit vectors square to a unit one and to each other (Duff et al. 2017).
glm::mat3 basisAround(glm::vec3 axis);

/// A direction of the cap of a sphere about an axis, uniform in solid angle.
/// basis            its third column is the axis
/// oneMinusCosine   of the cap's half angle, 0 to 2
glm::vec3 directionOfCap(const glm::mat3& basis, float oneMinusCosine, glm::vec2 square);

/// A direction of the hemisphere about the basis' third column with density cos / π (Malley).
glm::vec3 directionByCosine(const glm::mat3& basis, glm::vec2 square);

} // namespace brickfield
