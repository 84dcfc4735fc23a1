// Distances from points to triangles in GLSL against their twin and against the bakers' closest points in double.
#include <random>

#include "bakers/mesh_distance.h"
#include "shared/world_field_params.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/gpu/passes/triangle_twin.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

struct Query {
  glm::vec3 p, a, b, c;
};

double segmentDistance(glm::dvec3 p, glm::dvec3 from, glm::dvec3 to) {
  const glm::dvec3 along = to - from;
  const double squared = glm::dot(along, along);
  return glm::distance(p,
                       squared > 0 ? from + glm::clamp(glm::dot(p - from, along) / squared, 0.0, 1.0) * along : from);
}

// The bakers know no triangles without area; those are their edges.
double trueDistance(glm::dvec3 p, const std::array<glm::dvec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  if (glm::length(glm::cross(b - a, c - a)) > 0) return glm::distance(p, closestPointOnTriangle(p, corners).point);
  return std::min({segmentDistance(p, a, b), segmentDistance(p, b, c), segmentDistance(p, c, a)});
}

struct Answer {
  float squared;
  glm::vec3 closest;
  std::uint32_t feature;
  float fastSquared;
};

class TriangleDistanceTest : public GlTest {
protected:
  std::vector<Answer> ask(const std::vector<Query>& queries) {
    std::vector<glm::vec4> inputs;
    for (const Query& q : queries)
      for (const glm::vec3& row : {q.p, q.a, q.b, q.c}) inputs.emplace_back(row, 0);
    const auto program = bench_.load("#include \"lib/triangle_distance.glsl\"\n", R"(
  vec3 p = inputs[4u * index].xyz, a = inputs[4u * index + 1u].xyz;
  vec3 b = inputs[4u * index + 2u].xyz, c = inputs[4u * index + 3u].xyz;
  TriangleHit hit = closestOnTriangle(p, a, b, c);
  outputs[2u * index] = vec4(hit.closest, hit.squared);
  outputs[2u * index + 1u] = vec4(float(hit.feature), squaredTriangleDistance(p, a, b, c), 0.0, 0.0);)");
    const std::vector<glm::vec4> rows = ShaderBench::run(*program, inputs, queries.size(), 2);
    std::vector<Answer> answers;
    for (std::size_t i = 0; i < queries.size(); ++i)
      answers.push_back(
          {rows[2 * i].w, glm::vec3(rows[2 * i]), static_cast<std::uint32_t>(rows[2 * i + 1].x), rows[2 * i + 1].y});
    return answers;
  }

  // Every answer against double; returns how often each feature was the closest.
  std::array<int, 7> expectTrue(const std::vector<Query>& queries, const std::string& name) {
    std::array<int, 7> counts{};
    const std::vector<Answer> answers = ask(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      expectOne(queries[i], answers[i], name + " " + std::to_string(i));
      ++counts.at(answers[i].feature);
      if (HasFailure()) break;
    }
    return counts;
  }

  static void expectOne(const Query& q, const Answer& answer, const std::string& name) {
    const std::array<glm::dvec3, 3> corners{q.a, q.b, q.c};
    const glm::dvec3 p(q.p);
    const double truth = trueDistance(p, corners);
    double far = 0, longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      far = std::max(far, glm::distance(p, corners[k]));
      longest = std::max(longest, glm::distance(corners[k], corners[(k + 1) % 3]));
    }
    const double height =
        longest > 0 ? glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / longest : 0;
    // Differences of coordinates are rounded once, offsets along edges a few times more: 16 roundings of the farthest
    // corner's distance. A foot on a thin face slides by its length over its height times that; but then an edge is
    // no farther away than the height.
    const double rounding = std::ldexp(16.0, -24) * far;
    const double slide = height > 0 ? std::min(height, rounding * longest / height) : 0;
    for (const float squared : {answer.squared, answer.fastSquared}) {
      EXPECT_GE(std::sqrt(squared), truth - rounding) << name;
      EXPECT_LE(std::sqrt(squared), truth + rounding + slide) << name;
    }
    EXPECT_NEAR(glm::distance(p, glm::dvec3(answer.closest)), std::sqrt(answer.squared),
                rounding + std::ldexp(4.0, -24) * glm::length(p))
        << name;
    // The closest point lies on the feature that is named.
    const double off = rounding + std::ldexp(4.0, -24) * glm::length(p);
    const glm::dvec3 closest(answer.closest);
    if (answer.feature >= 1 && answer.feature <= 3) {
      EXPECT_LE(glm::distance(closest, corners[answer.feature - 1]), off) << name;
    }
    if (answer.feature >= 4) {
      const std::size_t k = answer.feature - 4;
      EXPECT_LE(segmentDistance(closest, corners[k], corners[(k + 1) % 3]), off) << name;
    }
    // Both sides of the twin round alike, up to fused operations of the driver.
    const TriangleHit<float> twin = closestOnTriangle(q.p, q.a, q.b, q.c);
    EXPECT_NEAR(std::sqrt(answer.squared), std::sqrt(twin.squared), 2 * rounding + slide) << name;
  }

  ShaderBench bench_;
};

// Points and triangles of a size around a place, squashed to a thinness.
std::vector<Query> randomQueries(std::uint32_t seed, int count, float size, float thinness, float pointReach,
                                 glm::vec3 place) {
  std::mt19937 engine(seed);
  const auto unit = [&] { return 2.0f * static_cast<float>(engine() >> 8) / static_cast<float>(1u << 24) - 1.0f; };
  const auto vector = [&] { return glm::vec3(unit(), unit(), unit()); };
  std::vector<Query> queries;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 a = size * vector(), b = size * vector();
    const glm::vec3 c = glm::mix(a, b, 0.5f + 0.7f * unit()) + thinness * size * vector();
    queries.push_back({place + pointReach * vector(), place + a, place + b, place + c});
  }
  return queries;
}

TEST_F(TriangleDistanceTest, RandomTrianglesOfAllSizes) {
  std::uint32_t seed = 1;
  for (const float size : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f})
    for (const float reach : {0.5f, 2.0f, 100.0f}) {
      const auto counts = expectTrue(randomQueries(seed++, 2000, size, 1, reach * size, glm::vec3(0)), "random");
      if (reach == 2.0f) {
        for (const int count : counts) EXPECT_GT(count, 20);
      } // every feature was met
    }
}

TEST_F(TriangleDistanceTest, FarFromZeroAndFarFromTheTriangle) {
  expectTrue(randomQueries(30, 2000, 1, 1, 3, {1000, -500, 250}), "moved");
  expectTrue(randomQueries(31, 2000, 1e-3f, 1, 1e4f, glm::vec3(0)), "far");
}

TEST_F(TriangleDistanceTest, NeedlesNeverComeNearerThanTheyAre) {
  std::uint32_t seed = 50;
  for (const float thinness : {1e-2f, 1e-3f, 1e-4f, 1e-5f, 1e-6f, 1e-7f})
    for (const float reach : {1e-3f, 1.0f})
      expectTrue(randomQueries(seed++, 2000, 1, thinness, reach, glm::vec3(0)), "needle");
}

TEST_F(TriangleDistanceTest, DegenerateTrianglesAreSegmentsAndPoints) {
  std::vector<Query> queries;
  for (const Query& q : randomQueries(70, 500, 1, 1, 2, glm::vec3(0))) {
    queries.push_back({q.p, q.a, q.a, q.a});
    for (const auto& [a, b, c] : {std::array{q.a, q.a, q.b}, {q.a, q.b, q.a}, {q.a, q.b, q.b}})
      queries.push_back({q.p, a, b, c});
    queries.push_back({q.p, q.a, q.b, q.a + 0.5f * (q.b - q.a)});
    queries.push_back({q.a, q.a, q.b, q.c}); // the point is a corner
  }
  expectTrue(queries, "degenerate");
}

TEST_F(TriangleDistanceTest, PointsOnTheTriangleAreAtNoDistance) {
  std::vector<Query> queries;
  for (Query q : randomQueries(80, 1000, 1, 1, 2, glm::vec3(0))) {
    q.p = 0.5f * q.a + 0.25f * q.b + 0.25f * q.c;
    queries.push_back(q);
    q.p = 0.5f * q.a + 0.5f * q.b;
    queries.push_back(q);
  }
  expectTrue(queries, "on");
}

} // namespace
} // namespace brickfield::test
