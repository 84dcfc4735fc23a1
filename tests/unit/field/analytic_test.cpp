// Analytic distances by brute force, and what their fields promise where no brick is.
#include "field/analytic.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "field/brick_lookup.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

// Points of the surfaces, dense enough that the nearest of them is as good as the distance itself.
std::vector<glm::vec3> torusPoints(int rings, int turns) {
  std::vector<glm::vec3> points;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < turns; ++j) {
      const float a = 6.2831853f * static_cast<float>(i) / static_cast<float>(rings);
      const float b = 6.2831853f * static_cast<float>(j) / static_cast<float>(turns);
      const float r = kRing + kTube * std::cos(b);
      points.push_back(kCenter + glm::vec3(r * std::cos(a), kTube * std::sin(b), r * std::sin(a)));
    }
  return points;
}

std::vector<glm::vec3> boxPoints(int steps) {
  std::vector<glm::vec3> points;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f})
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= steps; ++j) {
          glm::vec3 unit;
          unit[axis] = side;
          unit[(axis + 1) % 3] = 2.0f * static_cast<float>(i) / static_cast<float>(steps) - 1;
          unit[(axis + 2) % 3] = 2.0f * static_cast<float>(j) / static_cast<float>(steps) - 1;
          points.push_back(kCenter + unit * kHalfExtent);
        }
  return points;
}

void expectNearest(const Body& body, const std::vector<glm::vec3>& points, float spacing) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 p = random.in(body.surface.expanded(0.5f));
    float nearest = std::numeric_limits<float>::infinity();
    for (const glm::vec3 q : points) nearest = std::min(nearest, glm::length(p - q));
    const float distance = std::abs(body.distance(p));
    ASSERT_LE(distance, nearest + 1e-5f) << body.name;
    // The nearest sample is at most a spacing beside the nearest point.
    ASSERT_GE(distance, std::sqrt(std::max(0.0f, nearest * nearest - spacing * spacing)) - spacing) << body.name;
  }
}

TEST(AnalyticDistance, IsTheNearestPoint) {
  expectNearest(torusBody(), torusPoints(400, 120), 0.025f);
  expectNearest(boxBody(), boxPoints(120), 0.015f);
}

TEST(AnalyticDistance, KnownValues) {
  EXPECT_FLOAT_EQ(sphereDistance({3, 4, 0}, {0, 0, 0}, 2), 3);
  EXPECT_FLOAT_EQ(sphereDistance({0, 0, 0}, {0, 0, 0}, 2), -2);
  EXPECT_FLOAT_EQ(boxDistance({0, 0, 0}, {0, 0, 0}, {1, 2, 3}), -1);
  EXPECT_FLOAT_EQ(boxDistance({4, 6, 0}, {0, 0, 0}, {1, 2, 3}), 5);
  EXPECT_FLOAT_EQ(boxDistance({0, 2.5f, 0}, {0, 0, 0}, {1, 2, 3}), 0.5f);
  EXPECT_FLOAT_EQ(torusDistance({0, 0, 2}, {0, 0, 0}, 2, 0.5f), -0.5f);
  EXPECT_FLOAT_EQ(torusDistance({2, 1, 0}, {0, 0, 0}, 2, 0.5f), 0.5f);
  EXPECT_FLOAT_EQ(planeDistance({5, 3, 1}, {0, 1, 0}, 2), 1);
}

TEST(MakeAnalyticField, EmptyCellsNeverExceedTheTruth) {
  std::vector<Body> all = bodies();
  all.push_back({"plane",
                 [](glm::vec3 p) { return planeDistance(p, glm::normalize(glm::vec3(1, 2, 3)), 0.1f); },
                 {glm::vec3(-1), glm::vec3(1)},
                 {}});
  for (const Body& body : all) {
    const BrickField field = fieldOf(body, 120, 8, 3);
    for (std::size_t l = 0; l + 1 < field.levels.size(); ++l) {
      const BrickLevel& level = field.levels[l];
      int empty = 0;
      for (int z = 0; z < level.brickCounts.z; ++z)
        for (int y = 0; y < level.brickCounts.y; ++y)
          for (int x = 0; x < level.brickCounts.x; ++x) {
            const IndirectionCell cell = cellAt(level, {x, y, z});
            if (!cell.isEmpty()) continue;
            ++empty;
            ASSERT_GE(cell.boundVoxels(), kTouchVoxels); // else it were stored
            for (int i = 0; i < 11 * 11 * 11; ++i) {     // of the closed brick, corners and borders among them
              const glm::vec3 part = 0.7f * glm::vec3(i % 11, i / 11 % 11, i / 121);
              const glm::vec3 p = field.originObject + level.voxelSizeObject * (7.0f * glm::vec3(x, y, z) + part);
              const float truth = body.distance(p) / level.voxelSizeObject;
              ASSERT_LE(cell.boundVoxels(), std::abs(truth)) << body.name << " level " << l;
              ASSERT_EQ(cell.isInside(), truth < 0) << body.name << " level " << l;
            }
          }
      EXPECT_GT(empty, l == 0 ? 100 : 0) << body.name << " level " << l;
    }
  }
}

TEST(MakeAnalyticField, AVoxelAroundTheSurfaceIsStored) {
  for (const Body& body : bodies()) {
    const BrickField field = fieldOf(body, 64, 8, 3);
    Random random(6);
    for (std::size_t l = 0; l < field.levels.size(); ++l) {
      const BrickLevel& level = field.levels[l];
      for (int i = 0; i < 100000; ++i) {
        const glm::vec3 point = random.in(field.boundsObject);
        if (std::abs(body.distance(point)) > level.voxelSizeObject) continue;
        const glm::dvec3 at = (glm::dvec3(point) - glm::dvec3(field.originObject)) / double(level.voxelSizeObject);
        ASSERT_FALSE(cellAt(level, brickOfVoxel(voxelAt(level, at))).isEmpty()) << body.name;
      }
    }
  }
}

TEST(MakeAnalyticField, LayoutAndFormats) {
  const BrickField field = fieldOf(sphereBody(), 64, 8, 3);
  ASSERT_EQ(field.levels.size(), 3u);
  EXPECT_EQ(field.originObject, field.boundsObject.min);
  EXPECT_EQ(field.levels[0].format, DistanceFormat::R8Snorm);
  EXPECT_EQ(field.levels[0].rangeVoxels, 4);
  EXPECT_EQ(field.levels[2].format, DistanceFormat::R16Snorm);
  EXPECT_EQ(field.levels[2].brickCount(), field.levels[2].indirection.size());
  EXPECT_GE(field.levels[2].rangeVoxels, 7.0f); // the sphere's radius is 8 voxels of the third level
  EXPECT_EQ(fieldOf(sphereBody(), 64, 16, 1).levels[0].format, DistanceFormat::R16Snorm);
}

TEST(MakeAnalyticField, RefusesDistancesThatAreNotFinite) {
  const Box box{glm::vec3(-1), glm::vec3(1)};
  EXPECT_THROW(makeAnalyticField([](glm::vec3) { return std::nanf(""); }, box, 16, 8, 1), BadInput);
  EXPECT_THROW(makeAnalyticField([](glm::vec3 p) { return 1.0f / (p.x < 0 ? 0.0f : 1.0f); }, box, 64, 8, 2), BadInput);
  EXPECT_THROW(makeAnalyticField([](glm::vec3) { return 1e9f; }, box, 16, 8, 1), BadInput) << "beyond any range";
  EXPECT_THROW(makeAnalyticField([](glm::vec3) { return 1.0f; }, box, 16, 9, 1), BadInput);
}

TEST(AddAttributes, StandWhereTheirSamplesAre) {
  BrickField field = fieldOf(sphereBody(), 40, 8, 2);
  addAttributes(field, [](glm::vec3 p) {
    SurfaceAttributes a;
    a.baseColor = p.x < kCenter.x ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 1, 0, 0.5f);
    a.metallic = p.y < kCenter.y ? 1.0f : 0.0f;
    a.unlit = true;
    return a;
  });
  ASSERT_EQ(validateField(field), "");
  for (const BrickLevel& level : field.levels) {
    EXPECT_TRUE(level.emission.empty()) << "nothing emits";
    for (int z = 0; z < level.brickCounts.z; ++z)
      for (int y = 0; y < level.brickCounts.y; ++y)
        for (int x = 0; x < level.brickCounts.x; ++x) {
          const IndirectionCell cell = cellAt(level, {x, y, z});
          if (cell.isEmpty()) continue;
          const glm::ivec3 sample(2, 5, 7);
          const glm::vec3 p = samplePointObject(field.originObject, level.voxelSizeObject, {x, y, z}, sample);
          const std::size_t i = cell.brickIndex() * 512u + sampleIndex(sample);
          ASSERT_EQ(level.baseColor[i], p.x < kCenter.x ? 0xff0000ffu : 0x8000ff00u);
          ASSERT_EQ(level.material[i], p.y < kCenter.y ? 0xffffffffu : 0xffffff00u);
        }
  }
  addAttributes(field, [](glm::vec3) {
    SurfaceAttributes a;
    a.emission = {1, 1, 1};
    return a;
  });
  ASSERT_EQ(validateField(field), "");
  EXPECT_EQ(field.levels[0].emission.at(0), packRgb9e5({1, 1, 1}));
}

} // namespace
} // namespace brickfield
