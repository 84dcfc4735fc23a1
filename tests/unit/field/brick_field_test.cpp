// Encoding, sampling and normals against closed forms.
#include "field/brick_field.h"

#include <gtest/gtest.h>

#include "field/brick_lookup.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

TEST(EncodeDistance, KeepsHalfACodeAndTheSign) {
  for (const auto format : {DistanceFormat::R8Snorm, DistanceFormat::R16Snorm}) {
    const float code = 4.0f / (format == DistanceFormat::R8Snorm ? 127.0f : 32767.0f);
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
      const float distance = random.between(-4, 4) * (i % 2 ? 1.0f : 0.02f);
      const float decoded = decodeDistance(encodeDistance(distance, 4, format), 4, format);
      EXPECT_EQ(decoded < 0, distance < 0) << distance;
      // Negative distances that would round to zero take the code -1, and so miss by up to one code.
      const float bound = distance < 0 && distance > -0.5f * code ? code : 0.5f * code;
      EXPECT_LE(std::abs(decoded - distance), bound + 1e-6f) << distance;
    }
  }
}

TEST(EncodeDistance, EndsAndOddValues) {
  const auto r8 = DistanceFormat::R8Snorm;
  EXPECT_EQ(encodeDistance(4, 4, r8), 127);
  EXPECT_EQ(encodeDistance(-4, 4, r8), -127);
  EXPECT_EQ(encodeDistance(1e30f, 4, r8), 127);
  EXPECT_EQ(encodeDistance(-1e30f, 4, r8), -127);
  EXPECT_EQ(encodeDistance(0, 4, r8), 0);
  EXPECT_EQ(encodeDistance(-0.0f, 4, r8), 0);
  EXPECT_EQ(encodeDistance(-1e-30f, 4, r8), -1);
  EXPECT_EQ(encodeDistance(1e-30f, 4, r8), 0);
  EXPECT_EQ(encodeDistance(std::nanf(""), 4, r8), 127);
  EXPECT_EQ(encodeDistance(-std::numeric_limits<float>::infinity(), 4, DistanceFormat::R16Snorm), -32767);
  EXPECT_EQ(decodeDistance(-128, 4, r8), -4);
  EXPECT_EQ(decodeDistance(-32768, 4, DistanceFormat::R16Snorm), -4);
  for (int code = -127; code <= 127; ++code) EXPECT_EQ(encodeDistance(decodeDistance(code, 4, r8), 4, r8), code);
}

TEST(IndirectionCell, BoundIsRoundedDown) {
  for (float bound = -1; bound < 20; bound += 0.01f) {
    const auto cell = IndirectionCell::empty(true, bound);
    EXPECT_TRUE(cell.isEmpty() && cell.isInside());
    EXPECT_LE(cell.boundVoxels(), std::max(bound, 0.0f));
    EXPECT_GT(cell.boundVoxels(), bound - 1.0f / 16.0f);
  }
  EXPECT_FLOAT_EQ(IndirectionCell::empty(false, 1e30f).boundVoxels(), 65535.0f / 16.0f);
  EXPECT_EQ(IndirectionCell::empty(false, std::nanf("")).boundVoxels(), 0.0f);
  EXPECT_FALSE(IndirectionCell::empty(false, 2).isInside());
  EXPECT_FALSE(IndirectionCell::brick(7).isEmpty());
  EXPECT_EQ(IndirectionCell::brick(7).brickIndex(), 7u);
}

// What encoding may add at a point: half a code, and as much again where a corner is negative by less than that.
float quantumVoxels(const Body& body, const BrickField& field, const BrickLevel& level, glm::vec3 point) {
  const float code = codeVoxels(level);
  const glm::dvec3 at = (glm::dvec3(point) - glm::dvec3(field.originObject)) / double(level.voxelSizeObject);
  const glm::ivec3 voxel = voxelAt(level, at);
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner =
        field.originObject + level.voxelSizeObject * glm::vec3(voxel + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
    const float distance = body.distance(corner) / level.voxelSizeObject;
    if (distance < 1e-4f && distance > -0.5f * code - 1e-4f) return code;
  }
  return 0.5f * code;
}

void expectSamplesWithinBound(const Body& body, const BrickField& field, std::size_t levelIndex) {
  const BrickLevel& level = field.levels[levelIndex];
  const float h = level.voxelSizeObject;
  Random random(static_cast<std::uint32_t>(levelIndex) + 5);
  int bandPoints = 0;
  for (int i = 0; i < 30000; ++i) {
    glm::vec3 point = random.in(field.boundsObject);
    // Two of three points are pulled towards the surface, where it matters.
    if (i % 3 != 0) {
      for (int step = 0; step < 2; ++step) {
        const float d = body.distance(point), e = 1e-3f;
        const glm::vec3 gradient{body.distance(point + glm::vec3(e, 0, 0)) - d,
                                 body.distance(point + glm::vec3(0, e, 0)) - d,
                                 body.distance(point + glm::vec3(0, 0, e)) - d};
        point -= gradient / e * (d + (step == 1 ? h * random.between(-2, 2) : 0.0f));
      }
      point = glm::clamp(point, field.boundsObject.min, field.boundsObject.max);
    }
    const float truth = body.distance(point) / h;
    const float found = sampleDistance(field, levelIndex, point) / h;
    const float error =
        trilinearErrorVoxels(body, point, h) + quantumVoxels(body, field, level, point) + floatErrorVoxels(h);
    if (std::abs(truth) + 1.74f < level.rangeVoxels && std::abs(truth) <= kTouchVoxels) { // no corner is clamped
      ++bandPoints;
      ASSERT_LE(std::abs(found - truth), error) << body.name << " level " << levelIndex << " distance " << truth;
    } else { // clamped, or the bound of an empty cell: never longer than the truth
      ASSERT_LE(std::abs(found), std::abs(truth) + error) << body.name << " level " << levelIndex;
      ASSERT_TRUE(std::abs(truth) <= error || std::signbit(found) == (truth < 0)) << body.name;
    }
  }
  EXPECT_GT(bandPoints, 5000);
}

TEST(SampleDistance, KeepsItsBoundOnAllBodies) {
  for (const Body& body : bodies())
    for (const int bits : {8, 16})
      for (const int resolution : {40, 97}) {
        const BrickField field = fieldOf(body, resolution, bits, 3);
        ASSERT_EQ(validateField(field), "");
        for (std::size_t level = 0; level < field.levels.size(); ++level) expectSamplesWithinBound(body, field, level);
      }
}

TEST(SampleDistance, CoarsestLevelIsWholeAndUnclamped) {
  const Body body = torusBody();
  const BrickField field = fieldOf(body, 64, 8, 3);
  const std::size_t coarsest = field.levels.size() - 1;
  const float h = field.levels[coarsest].voxelSizeObject;
  Random random(9);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 point = random.in(field.boundsObject);
    const float truth = body.distance(point) / h;
    const float error = trilinearErrorVoxels(body, point, h) + codeVoxels(field.levels[coarsest]) + floatErrorVoxels(h);
    ASSERT_LE(std::abs(sampleDistance(field, coarsest, point) / h - truth), error);
  }
}

TEST(SampleDistance, IsContinuousAcrossBricks) {
  const BrickField field = fieldOf(torusBody(), 60, 8, 2);
  for (std::size_t levelIndex = 0; levelIndex < field.levels.size(); ++levelIndex) {
    const BrickLevel& level = field.levels[levelIndex];
    Random random(3);
    int pairs = 0;
    for (int z = 0; z < level.brickCounts.z; ++z)
      for (int y = 0; y < level.brickCounts.y; ++y)
        for (int x = 0; x + 1 < level.brickCounts.x; ++x) {
          if (cellAt(level, {x, y, z}).isEmpty() || cellAt(level, {x + 1, y, z}).isEmpty()) continue;
          ++pairs;
          for (int i = 0; i < 20; ++i) {
            const glm::dvec3 border(7.0 * (x + 1), 7.0 * (y + random.unit()), 7.0 * (z + random.unit()));
            const glm::dvec3 hair(1e-7, 0, 0);
            // Slopes are below 1 voxel a voxel and two codes; the border is 2e-7 voxel wide here.
            ASSERT_NEAR(sampleVoxels(level, border - hair), sampleVoxels(level, border + hair), 4e-7);
          }
          for (int i = 0; i < 64; ++i)
            ASSERT_EQ(storedDistance(level, cellAt(level, {x, y, z}).brickIndex(), {7, i % 8, i / 8}),
                      storedDistance(level, cellAt(level, {x + 1, y, z}).brickIndex(), {0, i % 8, i / 8}));
        }
    EXPECT_GT(pairs, 10);
  }
}

TEST(SampleDistance, IsClampedToTheGrid) {
  const BrickField field = fieldOf(sphereBody(), 32, 8, 2);
  const glm::vec3 far(1e30f, 0, 0), inBounds(field.originObject.x + 1000.0f, 0, 0);
  EXPECT_EQ(sampleDistance(field, 0, far), sampleDistance(field, 0, inBounds));
  EXPECT_TRUE(std::isfinite(sampleDistance(field, 1, glm::vec3(-3e38f))));
}

TEST(FieldNormal, PointsAsTheClosedForm) {
  struct Case {
    Body body;
    std::function<glm::vec3(glm::vec3)> normal;
  };
  const auto torusNormal = [](glm::vec3 p) {
    const glm::vec3 q = p - kCenter;
    const glm::vec3 ring = glm::normalize(glm::vec3(q.x, 0, q.z)) * kRing;
    return glm::normalize(q - ring);
  };
  for (const Case& c :
       {Case{sphereBody(), [](glm::vec3 p) { return glm::normalize(p - kCenter); }}, Case{torusBody(), torusNormal}})
    for (const int bits : {8, 16}) {
      const BrickField field = fieldOf(c.body, 96, bits, 2);
      const float h = field.levels[0].voxelSizeObject;
      Random random(11);
      for (int i = 0; i < 5000; ++i) {
        glm::vec3 point = random.in(c.body.surface);
        if (glm::length(point - kCenter) < 0.2f) continue; // no normal at the centre, nor on the axis below
        point -= c.normal(point) * c.body.distance(point);
        if (!(std::abs(c.body.distance(point)) < 1e-4f)) continue;
        const glm::vec3 normal = fieldNormal(field, 0, point);
        EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
        // A component is a difference of two samples over one voxel, each off by a code and the trilinear error at
        // half a voxel's distance, and differs from the derivative by h^2/24 f''' (about the squared curvature).
        const float curvature = c.body.curvature(point, 2.3f * h) * h;
        const float component = 2 * codeVoxels(field.levels[0]) + 2 * 3.0f / 8.0f * curvature +
                                curvature * curvature / 8 + 2 * floatErrorVoxels(h);
        const float sine = std::sqrt(3.0f) * component;
        ASSERT_LE(glm::length(glm::cross(normal, c.normal(point))), sine) << c.body.name;
        ASSERT_GT(glm::dot(normal, c.normal(point)), 0.0f);
      }
    }
}

TEST(FieldNormal, IsAUnitVectorWhereTheFieldIsFlat) {
  const BrickField field = fieldOf(sphereBody(), 96, 8, 2);
  EXPECT_NEAR(glm::length(fieldNormal(field, 0, kCenter)), 1.0f, 1e-6f);
}

TEST(FieldBytes, CountsAllArrays) {
  BrickField field = fieldOf(sphereBody(), 32, 8, 1);
  const std::size_t bare = field.levels[0].indirection.size() * 4 + field.levels[0].distances.size();
  EXPECT_EQ(fieldBytes(field), bare);
  addAttributes(field, [](glm::vec3) { return SurfaceAttributes{}; });
  EXPECT_EQ(fieldBytes(field), bare + field.levels[0].brickCount() * 512u * 8u);
}

} // namespace
} // namespace brickfield
