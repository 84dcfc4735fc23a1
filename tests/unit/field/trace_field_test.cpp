// Tracing against closed forms. A reconstructed surface lies within `delta` of the true one, so that a ray must meet it
// between the surfaces offset by +delta and -delta: spheres and tori offset to spheres and tori, whose crossings are
// roots of polynomials. A ray that misses the outer one must miss; one that meets the inner one must hit.
#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;
using Polynomial = std::vector<double>; // lowest power first

double evaluate(const Polynomial& p, double t) {
  double value = 0;
  for (auto c = p.rbegin(); c != p.rend(); ++c) value = value * t + *c;
  return value;
}

// All real roots in [low, high] with a change of sign: between two roots of the derivative there is at most one.
std::vector<double> roots(const Polynomial& p, double low, double high) {
  if (p.size() < 2) return {};
  Polynomial derivative;
  for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<double>(i) * p[i]);
  std::vector<double> knots{low};
  for (const double t : roots(derivative, low, high)) knots.push_back(t);
  knots.push_back(high);
  std::vector<double> found;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    double a = knots[i], b = knots[i + 1];
    const bool rises = evaluate(p, a) < 0;
    if (rises == (evaluate(p, b) < 0)) continue;
    for (int step = 0; step < 100; ++step) {
      const double middle = 0.5 * (a + b);
      ((evaluate(p, middle) < 0) == rises ? a : b) = middle;
    }
    found.push_back(0.5 * (a + b));
  }
  return found;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

Polynomial squaredLength(glm::dvec3 o, glm::dvec3 d) { return {glm::dot(o, o), 2 * glm::dot(o, d), glm::dot(d, d)}; }

// Negative inside. Sphere: |p|^2 - r^2. Torus: (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + z^2).
struct Solid {
  Body body;
  std::function<Polynomial(glm::dvec3 origin, glm::dvec3 direction, double offset)> along;
};

Solid sphereSolid() {
  return {sphereBody(), [](glm::dvec3 o, glm::dvec3 d, double offset) {
            Polynomial p = squaredLength(o - glm::dvec3(kCenter), d);
            p[0] -= (kRadius + offset) * (kRadius + offset);
            return p;
          }};
}

Solid torusSolid() {
  return {torusBody(), [](glm::dvec3 o, glm::dvec3 d, double offset) {
            const glm::dvec3 q = o - glm::dvec3(kCenter);
            const double ring = kRing, tube = kTube + offset;
            Polynomial sum = squaredLength(q, d);
            sum[0] += ring * ring - tube * tube;
            const Polynomial flat = squaredLength({q.x, 0, q.z}, {d.x, 0, d.z});
            Polynomial p = product(sum, sum);
            for (std::size_t i = 0; i < 3; ++i) p[i] -= 4 * ring * ring * flat[i];
            return p;
          }};
}

constexpr double kFar = 20;

// First entry at or after `from`, of a ray that is outside there.
std::optional<double> firstEntry(const Solid& solid, glm::dvec3 o, glm::dvec3 d, double offset, double from = 0) {
  const Polynomial p = solid.along(o, d, offset);
  const auto all = roots(p, from, kFar);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

// How far beside the true surface the reconstructed one may lie, in metres: a code, the trilinear error at the surface
// (a curvature bounded two voxels around it) and floats.
double deltaOf(const BrickLevel& level, float leastRadius) {
  const float h = level.voxelSizeObject;
  const float curvature = 1.0f / (leastRadius - 2.5f * h);
  return double(h) * (codeVoxels(level) + 3.0f / 8.0f * curvature * h) + 5e-6;
}

struct Tally {
  int hits = 0, misses = 0, undecided = 0;
};

// Shoots random rays from outside and checks every one.
Tally shoot(const Solid& solid, const BrickField& field, std::size_t level, float leastRadius, int rays) {
  const double delta = deltaOf(field.levels[level], leastRadius);
  Random random(17);
  Tally tally;
  for (int i = 0; i < rays; ++i) {
    const glm::vec3 target = random.in(solid.body.surface.expanded(0.1f));
    const glm::vec3 origin = kCenter + 4.0f * random.direction();
    const glm::vec3 direction = glm::normalize(target - origin);
    const auto outer = firstEntry(solid, origin, direction, delta),
               inner = firstEntry(solid, origin, direction, -delta);
    const auto found = traceField(field, level, origin, direction, 0, kFar);
    if (!outer) {
      EXPECT_FALSE(found) << solid.body.name << " ray " << i << " level " << level << " hits at " << *found;
      ++tally.misses;
      continue;
    }
    if (found) {
      EXPECT_GE(*found, *outer - 1e-5) << solid.body.name << " ray " << i << " level " << level;
      EXPECT_LE(std::abs(solid.body.distance(origin + *found * direction)), delta + 5e-6) << i;
    }
    if (!inner) {
      ++tally.undecided;
      continue;
    }
    ++tally.hits;
    if (!found)
      ADD_FAILURE() << solid.body.name << " ray " << i << " level " << level << " misses " << *inner;
    else
      EXPECT_LE(*found, *inner + 1e-5) << solid.body.name << " ray " << i << " level " << level;
  }
  return tally;
}

TEST(TraceField, AgreesWithTheSphereOn10000Rays) {
  for (const int bits : {8, 16}) {
    const BrickField field = fieldOf(sphereBody(), 64, bits, 3);
    for (std::size_t level = 0; level < field.levels.size(); ++level) {
      const Tally tally = shoot(sphereSolid(), field, level, kRadius, 10000);
      EXPECT_GT(tally.hits, 4000);
      EXPECT_GT(tally.misses, 500);
      EXPECT_LT(tally.undecided, 500); // the test decides nearly all
    }
  }
}

TEST(TraceField, AgreesWithTheTorusOn10000Rays) {
  for (const int bits : {8, 16}) {
    const BrickField field = fieldOf(torusBody(), 96, bits, 3);
    for (std::size_t level = 0; level < 2; ++level) { // the third has voxels too coarse for the tube's curvature bound
      const Tally tally = shoot(torusSolid(), field, level, kTube, 10000);
      EXPECT_GT(tally.hits, 4000);
      EXPECT_GT(tally.misses, 500);
      EXPECT_LT(tally.undecided, 500);
    }
  }
}

// A plate of 1.3 voxels at 80 voxels, tilted against the grid: the thinnest that the samples still see everywhere.
Body plateBody() {
  const glm::mat3 plateFromObject = glm::mat3_cast(glm::angleAxis(0.6f, glm::normalize(glm::vec3(1, 2, 3))));
  const glm::vec3 halfExtent(0.8f, 0.0125f, 0.6f);
  return {"plate",
          [=](glm::vec3 p) { return boxDistance(plateFromObject * p, glm::vec3(0), halfExtent); },
          {glm::vec3(-0.9f), glm::vec3(0.9f)},
          {}};
}

TEST(TraceField, FindsTheFirstZeroOfTheReconstruction) {
  // Whatever the true surface, the walk must stop where the samples first turn negative, as marching by a 64th of a
  // voxel finds it: no safe step may jump over a dip or end inside.
  std::vector<Body> all = bodies();
  all.push_back(plateBody());
  for (const Body& body : all) {
    const BrickField field = fieldOf(body, 80, 8, 2);
    for (std::size_t level = 0; level < field.levels.size(); ++level) {
      const float h = field.levels[level].voxelSizeObject;
      const auto voxelsAt = [&](glm::vec3 p) { return sampleDistance(field, level, p) / h; };
      Random random(40);
      int hits = 0;
      for (int i = 0; i < 700; ++i) {
        const glm::vec3 origin = body.surface.center() + 1.9f * random.direction();
        const glm::vec3 direction = glm::normalize(random.in(body.surface) - origin);
        const auto found = traceField(field, level, origin, direction, 0, kFar);
        // A float parameter below 8 is exact to 2.4e-7 m and a point of it to about as much again.
        const float slack = 2e-6f / h;
        if (found) {
          ++hits;
          ASSERT_LE(std::abs(voxelsAt(origin + *found * direction)), slack)
              << body.name << " ray " << i << " level " << level;
        }
        for (float t = 0; t < (found ? *found : 4.0f); t += h / 64) {
          const glm::vec3 point = origin + t * direction;
          if (field.boundsObject.contains(point)) {
            ASSERT_GE(voxelsAt(point), -slack)
                << body.name << " ray " << i << " level " << level << " passes a surface at " << t;
          }
        }
      }
      EXPECT_GT(hits, 100) << body.name;
    }
  }
}

TEST(TraceField, DepthErrorIsBoundedByTheSlope) {
  // Rays within 0.4 m of the centre meet the 0.9 m sphere within asin(0.4 / 0.9) = 26 degrees of its normal.
  const Solid solid = sphereSolid();
  const BrickField field = fieldOf(solid.body, 128, 16, 1);
  const double delta = deltaOf(field.levels[0], kRadius);
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 origin = kCenter + 3.0f * random.direction();
    const glm::vec3 direction = glm::normalize(kCenter + 0.4f * random.direction() - origin);
    const auto truth = firstEntry(solid, origin, direction, 0);
    const auto found = traceField(field, 0, origin, direction, 0, kFar);
    ASSERT_TRUE(truth && found);
    ASSERT_NEAR(*found, *truth, delta / std::cos(0.5235988) + 1e-5);
  }
}

TEST(TraceField, FromInsideLeavesFirst) {
  const BrickField sphere = fieldOf(sphereBody(), 64, 8, 3);
  const Solid torus = torusSolid();
  const BrickField ring = fieldOf(torus.body, 96, 8, 1);
  const double delta = deltaOf(ring.levels[0], kTube);
  Random random(8);
  int reentries = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 direction = random.direction();
    for (std::size_t level = 0; level < 3; ++level) // a convex body is never entered again
      ASSERT_FALSE(traceField(sphere, level, kCenter + 0.6f * random.unit() * random.direction(), direction, 0, kFar));

    const glm::vec3 origin = kCenter + glm::vec3(kRing, 0, 0) + 0.2f * random.unit() * random.direction();
    const auto outer = roots(torus.along(origin, direction, delta), 0, kFar);
    const auto inner = roots(torus.along(origin, direction, -delta), 0, kFar);
    if (outer.size() != inner.size()) continue;
    const auto found = traceField(ring, 0, origin, direction, 0, kFar);
    if (outer.size() < 3) {
      ASSERT_FALSE(found) << i;
    } else {
      ++reentries;
      ASSERT_TRUE(found) << i;
      ASSERT_GE(*found, outer[1] - 1e-5) << i;
      ASSERT_LE(*found, inner[1] + 1e-5) << i;
    }
  }
  EXPECT_GT(reentries, 100);
}

TEST(TraceField, GrazingRaysTurnAtTheOffset) {
  const BrickField field = fieldOf(sphereBody(), 64, 8, 3);
  for (std::size_t level = 0; level < field.levels.size(); ++level) {
    const auto delta = static_cast<float>(deltaOf(field.levels[level], kRadius));
    Random random(21);
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 direction = random.direction();
      const glm::vec3 beside = glm::normalize(glm::cross(direction, random.direction()));
      const auto at = [&](float radius) { return kCenter + radius * beside - 5.0f * direction; };
      ASSERT_FALSE(traceField(field, level, at(kRadius + 1.01f * delta), direction, 0, kFar)) << i;
      ASSERT_TRUE(traceField(field, level, at(kRadius - 1.01f * delta), direction, 0, kFar)) << i;
    }
  }
}

TEST(TraceField, AxisParallelRaysOnBrickBorders) {
  // Rays that run exactly in the planes between voxels and bricks, with components of +0, -0 and nearly 0.
  const BrickField field = fieldOf(sphereBody(), 64, 8, 1);
  const float h = field.levels[0].voxelSizeObject;
  const double delta = deltaOf(field.levels[0], kRadius);
  const Solid solid = sphereSolid();
  int hits = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.0f, -1.0f})
      for (const float other : {0.0f, -0.0f, 1e-8f, -1e-8f, 1e-30f, -1e-42f})
        for (int i = 7; i < 66; i += 7)
          for (int j = 7; j < 66; j += 3) {
            glm::vec3 origin = field.originObject, direction(other);
            origin[(axis + 1) % 3] += h * static_cast<float>(i);
            origin[(axis + 2) % 3] += h * static_cast<float>(j);
            origin[axis] = kCenter[axis] - 3 * side;
            direction[axis] = side;
            const auto outer = firstEntry(solid, origin, direction, delta),
                       inner = firstEntry(solid, origin, direction, -delta);
            const auto found = traceField(field, 0, origin, direction, 0, kFar);
            ASSERT_TRUE(outer || !found);
            if (!inner) continue;
            ++hits;
            ASSERT_TRUE(found) << axis << side << other << " " << i << " " << j;
            ASSERT_GE(*found, *outer - 1e-5);
            ASSERT_LE(*found, *inner + 1e-5);
          }
  EXPECT_GT(hits, 1000);
}

TEST(TraceField, StartsOnGridPoints) {
  // A voxel of 1/32 m and an origin of -33/32 m are exact, so these rays start on corners of voxels and bricks, where
  // the voxel ahead depends on the direction alone.
  const auto sphere = [](glm::vec3 p) { return sphereDistance(p, glm::vec3(0), 0.6f); };
  const BrickField field = makeAnalyticField(sphere, {glm::vec3(-1), glm::vec3(1)}, 64, 16, 1);
  ASSERT_EQ(field.levels[0].voxelSizeObject, 1.0f / 32);
  const auto delta = static_cast<float>(deltaOf(field.levels[0], 0.6f));
  Random random(50);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    glm::ivec3 sample;
    for (int axis = 0; axis < 3; ++axis) sample[axis] = static_cast<int>(random.bits() % 10) * (i % 2 ? 7 : 6);
    const glm::vec3 origin = field.originObject + glm::vec3(sample) / 32.0f;
    if (!field.boundsObject.contains(origin) || sphere(origin) < 0.1f) continue;
    const glm::vec3 direction = glm::normalize(0.5f * random.direction() - origin);
    const auto found = traceField(field, 0, origin, direction, 0, kFar);
    ++hits;
    ASSERT_TRUE(found) << i;
    ASSERT_LE(std::abs(sphere(origin + *found * direction)), delta) << i;
    ASSERT_LT(glm::dot(origin + *found * direction, direction), 0) << "the far side of the sphere";
  }
  EXPECT_GT(hits, 2000);
}

TEST(TraceField, FindsADipWithinAVoxel) {
  // Samples of +1 and -1 in a chequer make the saddle (1-2x)(1-2y) in the first voxel. Along y = x + 0.1 it is positive
  // at both ends of the voxel and negative between x = 0.4 and x = 0.5.
  BrickField field;
  field.boundsObject = {glm::vec3(0), glm::vec3(7)};
  BrickLevel level = makeLevel({1, glm::ivec3(1)}, DistanceFormat::R16Snorm);
  std::array<float, kBrickSampleCount> distances;
  distances.fill(4);
  for (int z = 0; z < 8; ++z)
    for (int i = 0; i < 4; ++i) distances[sampleIndex({i % 2, i / 2, z})] = i == 0 || i == 3 ? 1.0f : -1.0f;
  appendBrick(level, {0, 0, 0}, distances);
  field.levels.push_back(level);
  ASSERT_EQ(validateField(field), "");
  const auto found = traceField(field, 0, {0, 0.1f, 3.5f}, {1, 1, 0}, 0, 0.9f);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.4f, 1e-3f); // two codes of 4/32767 at a slope of 0.2
  EXPECT_FALSE(traceField(field, 0, {0, 0.1f, 3.5f}, {1, 1, 0}, 0, 0.39f));
  EXPECT_FALSE(traceField(field, 0, {0, 0.1f, 3.5f}, {1, 1, 0}, 0.45f, 0.9f)) << "starts in the dip and leaves it";
}

TEST(TraceField, RangesAndOddRays) {
  const BrickField field = fieldOf(sphereBody(), 64, 8, 2);
  const glm::vec3 origin = kCenter + glm::vec3(0, 0, 3);
  const glm::vec3 down(0, 0, -1);
  const auto hit = traceField(field, 0, origin, down, 0, kFar);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, 3 - kRadius, 1e-3f);
  EXPECT_FALSE(traceField(field, 0, origin, down, 0, *hit - 1e-3f)) << "ends before the surface";
  EXPECT_TRUE(traceField(field, 0, origin, down, *hit - 1e-3f, *hit + 1e-3f)) << "just around it";
  EXPECT_FALSE(traceField(field, 0, origin, down, *hit + 1e-3f, kFar)) << "starts behind the surface, inside";
  for (const float t : {0.0f, 2.0f, *hit, *hit + 0.1f}) EXPECT_FALSE(traceField(field, 0, origin, down, t, t));
  EXPECT_FALSE(traceField(field, 0, origin, down, 5, 1));
  EXPECT_FALSE(traceField(field, 0, origin, -down, 0, kFar));
  EXPECT_FALSE(traceField(field, 0, origin, glm::vec3(0), 0, kFar));
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(traceField(field, 0, origin, glm::vec3(nan, 0, 1), 0, kFar));
  EXPECT_FALSE(traceField(field, 0, glm::vec3(nan), down, 0, kFar));
  EXPECT_FALSE(traceField(field, 0, origin, glm::vec3(0, 0, infinity), 0, kFar));
  EXPECT_FALSE(traceField(field, 0, origin, down, nan, kFar));
  EXPECT_FALSE(traceField(field, 0, origin, down, 0, nan));
  EXPECT_EQ(traceField(field, 0, origin, down, -infinity, infinity), hit) << "an endless range is cut to the bounds";
  for (const float scale : {1e-3f, 1e3f}) {
    const auto scaled = traceField(field, 0, origin, scale * down, 0, 1e9f);
    ASSERT_TRUE(scaled);
    EXPECT_NEAR(*scaled * scale, *hit, 1e-5f);
  }
}

TEST(TraceField, BoxFaceOfTheBoundsIsNoSurface) {
  // A half space cut off by the bounds: from the side the ray starts in the solid, and the way out is no entry.
  const auto plane = [](glm::vec3 p) { return planeDistance(p, {0, 1, 0}, 0.0f); };
  const BrickField field = makeAnalyticField(plane, {glm::vec3(-1), glm::vec3(1)}, 48, 8, 2);
  for (std::size_t level = 0; level < 2; ++level) {
    EXPECT_FALSE(traceField(field, level, {-3, -0.5f, 0.1f}, {1, 0, 0}, 0, kFar));
    EXPECT_FALSE(traceField(field, level, {-3, -0.5f, 0.1f}, {1, 0.2f, 0}, 0, kFar)) << "leaves through the plane";
    EXPECT_FALSE(traceField(field, level, {-1.5f, 0.5f, 3}, {1, -0.5f, 0}, 0, kFar)) << "beside the bounds all along";
    const auto hit = traceField(field, level, {-1.5f, 0.5f, 0.1f}, {1, -0.5f, 0}, 0, kFar);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(*hit, 1.0f, 2 * codeVoxels(field.levels[level]) * field.levels[level].voxelSizeObject + 1e-5f);
  }
}

TEST(TraceField, EndsOnAnyValidField) {
  // Whatever validateField lets pass is traced to an end, and what it returns lies in the range.
  BrickField field = fieldOf(torusBody(), 40, 8, 2);
  Random random(33);
  for (BrickLevel& level : field.levels) {
    for (std::byte& b : level.distances) b = static_cast<std::byte>(random.bits());
    if (&level == &field.levels.back()) continue;
    for (std::uint32_t& cell : level.indirection)
      cell = random.unit() < 0.5f ? random.bits() % level.brickCount()
                                  : IndirectionCell::kEmptyBit | (random.bits() & 0x4000001fu);
  }
  ASSERT_EQ(validateField(field), "");
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 4000; ++i) {
    glm::vec3 direction = random.direction();
    if (i % 4 == 0) direction[i / 4 % 3] *= 1e-9f;
    const auto hit = traceField(field, static_cast<std::size_t>(i % 2), random.in(field.boundsObject.expanded(1)),
                                direction, 0.25f, 8);
    ASSERT_TRUE(!hit || (*hit >= 0.25f && *hit <= 8));
  }
  // About 1 ms for all when it was written; a walk that crawls by its nudge takes hours.
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 60.0);
}

} // namespace
} // namespace brickfield
