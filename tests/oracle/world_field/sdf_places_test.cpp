// The world field of an SDF object where floats are coarse, or metres the wrong measure: far from the origin, a
// centimetre large and ten kilometres.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"
#include "tests/support/world_field_stage.h"

namespace brickfield::test {
namespace {

// Of the torus of hand_scenes, around the z axis.
double torusDistance(glm::dvec3 p) { return std::hypot(std::hypot(p.x, p.y) - 0.6, p.z) - 0.22; }

class SdfPlaces : public GlTest {
protected:
  static FieldSnapshot fieldAt(const glm::mat4& worldFromObject, const FieldShape& shape, std::size_t cascade) {
    const TestScene scene(makeTransformedTorus(worldFromObject), "all", 64);
    WorldFieldStage stage(scene.scene(), scene.fields(), shape);
    stage.frame(scene.pose(), glm::dvec3(worldFromObject[3]));
    return stage.read(cascade);
  }

  static double farthestApart(const FieldSnapshot& a, const FieldSnapshot& b) {
    EXPECT_EQ(a.distances.size(), b.distances.size());
    double farthest = 0;
    for (std::size_t i = 0; i < a.distances.size(); ++i)
      farthest = std::max(farthest, std::abs(double{a.distances[i]} - b.distances[i]));
    return farthest;
  }

  // All in texels.
  struct Error {
    double rms = 0, worst = 0; // within four texels of the surface
    double above = 0;          // of the truth, outside and beyond
    std::size_t texels = 0;
  };
  static Error errorOf(const FieldSnapshot& field, glm::dvec3 center) {
    Error error;
    for (std::size_t i = 0; i < field.distances.size(); ++i) {
      const glm::ivec3 at = field.latticeOf(i) - field.window.firstTexel,
                       side = glm::min(at, field.window.texels - 1 - at);
      if (std::min({side.x, side.y, side.z}) < 5) continue; // borders end what lies behind
      const double truth = torusDistance(field.centerAnchored(i) + field.anchorWorld - center) / field.window.texelSize;
      const double off = field.distances[i] - truth;
      if (std::abs(truth) > 4) {
        if (truth > 0) error.above = std::max(error.above, off);
        continue;
      }
      error.rms += off * off;
      error.worst = std::max(error.worst, std::abs(off));
      ++error.texels;
    }
    error.rms = std::sqrt(error.rms / static_cast<double>(std::max<std::size_t>(error.texels, 1)));
    return error;
  }
};

// Instances stand in floats of the world: what the last place of their coordinates is worth may be added to the errors,
// and nothing else. Both places are multiples of every texel and window, so the lattices are the same around them.
TEST_F(SdfPlaces, FarFromTheOriginTheFieldIsAsGood) {
  const double texelSize = 1.0 / 32;
  for (const FieldShape& shape : {FieldShape{1, 64, texelSize, false}, FieldShape{2, 64, texelSize / 4, false}}) {
    const std::size_t cascade = static_cast<std::size_t>(shape.cascades) - 1;
    const FieldSnapshot near = fieldAt(glm::mat4(1), shape, cascade);
    const Error atOrigin = errorOf(near, glm::dvec3(0));
    ASSERT_GT(atOrigin.texels, 10000u);
    EXPECT_LT(atOrigin.rms, 0.1);
    for (const float distance : {1024.0f, 10240.0f}) {
      const glm::vec3 place(distance, -distance, distance);
      const FieldSnapshot far = fieldAt(glm::translate(glm::mat4(1), place), shape, cascade);
      EXPECT_EQ(far.window.firstTexel, near.window.firstTexel);
      const Error error = errorOf(far, glm::dvec3(place));
      const double lastPlace = (std::nextafter(distance, 2 * distance) - distance) / near.window.texelSize;
      std::printf("%g m, texel %g m: rms %.4f, at the origin %.4f; worst %.4f, %.4f; above %.4f, %.4f\n", distance,
                  near.window.texelSize, error.rms, atOrigin.rms, error.worst, atOrigin.worst, error.above,
                  atOrigin.above);
      EXPECT_EQ(error.texels, atOrigin.texels);
      EXPECT_LE(error.rms, atOrigin.rms + 0.01 + 0.5 * lastPlace);
      EXPECT_LE(error.worst, atOrigin.worst + 0.05 + lastPlace);
      EXPECT_LE(error.above, atOrigin.above + 0.05 + lastPlace) << "a ray would step through";
    }
  }
}

// Powers of two, so that nothing but the scale differs.
TEST_F(SdfPlaces, OfAnySizeTheFieldIsTheSame) {
  for (const bool isWhole : {true, false}) {
    const FieldShape shape{1, 64, 0, isWhole};
    const FieldSnapshot metres = fieldAt(glm::mat4(1), shape, 0);
    for (const int exponent : {-7, 13}) { // 1.3 cm and 13 km across
      const FieldSnapshot other = fieldAt(glm::scale(glm::mat4(1), glm::vec3(std::exp2(exponent))), shape, 0);
      EXPECT_NEAR(other.window.texelSize, metres.window.texelSize * std::exp2(exponent), 1e-6 * other.window.texelSize);
      const double apart = farthestApart(metres, other);
      std::printf("2^%d: %.4f texels apart\n", exponent, apart);
      EXPECT_LE(apart, 0.05) << exponent;
    }
  }
}

} // namespace
} // namespace brickfield::test
