// shaders/lib/brick_trace.glsl and bricks.glsl against the C++ twins and closed forms, on fields in the real atlas.
//
// A grazing ray may hit for one twin and miss for the other, so hits are held against the field itself: where a hit is,
// the reconstructed distance is 0 within eps; before it, and all along a miss, it is never below -eps. Then t agrees
// wherever the surface is met at an angle, which is checked as well.
#include <algorithm>

#include <fmt/format.h>

#include "field/brick_lookup.h"
#include "resident/brick_atlas.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/support/gl_fixture.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield::test {
namespace {

// A nudge over a voxel's border (1e-4) may pass a crossing by a slope of at most sqrt(3) and two codes: 1.9e-4. Points
// of up to 70 voxels, moved in single precision, are off by some 4 * 2^-24 * 70 = 2e-5, times the same slope.
constexpr double kEpsVoxels = 2.2e-4;

struct Ray {
  glm::dvec3 entryVoxels; // in voxels of the traced level, where it enters the bounds
  glm::dvec3 stepVoxels;  // per unit of t
  glm::vec3 originObject, directionObject;
  double tEntry = 0, tEnd = 0; // the part within the bounds
};

struct Hit {
  bool hit;
  float t;
  bool backFace;
  float steps;
};

// One field at one level.
struct Case {
  Body body;
  int bits;
  std::size_t level;
  const BrickField* field;
  std::uint32_t row; // in the level table
  std::string name() const { return fmt::format("{} {} bits level {}", body.name, bits, level); }
  const BrickLevel& bricks() const { return field->levels[level]; }
};

class BrickTrace : public GlTest {
protected:
  void SetUp() override {
    GlTest::SetUp();
    atlas_ = std::make_unique<BrickAtlas>();
    for (const Body& body : bodies())
      for (const int bits : {8, 16}) {
        fields_.push_back(std::make_unique<BrickField>(fieldOf(body, 64, bits, 3)));
        const std::uint32_t first = atlas_->field(atlas_->add(*fields_.back())).firstLevel;
        for (std::size_t level = 0; level < fields_.back()->levels.size(); ++level)
          cases_.push_back({body, bits, level, fields_.back().get(), first + static_cast<std::uint32_t>(level)});
      }
    ASSERT_EQ(cases_.size(), 18u);
    atlas_->bind();
    program_ = bench_.load("#include \"lib/brick_trace.glsl\"\nuniform uint levelRow;\nuniform bool doubleSided;", R"(
  vec4 origin = inputs[index * 2u], direction = inputs[index * 2u + 1u];
  TraceHit hit = traceBricks(sdfLevels[levelRow], origin.xyz, direction.xyz, vec2(0.0, origin.w), doubleSided, 2048u);
  outputs[index] = vec4(float(hit.hit), hit.t, float(hit.backFace), float(hit.steps));)");
  }

  // As the box pass does: the ray starts where it enters the bounds, t counts from there.
  std::vector<Hit> trace(const Case& traced, const std::vector<Ray>& rays, const std::vector<float>& ends,
                         bool doubleSided = false) {
    const double voxel = traced.bricks().voxelSizeObject, fine = traced.field->levels[0].voxelSizeObject;
    std::vector<glm::vec4> inputs;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      inputs.emplace_back(glm::vec3(rays[i].entryVoxels * (voxel / fine)), ends[i]);
      inputs.emplace_back(glm::vec3(rays[i].stepVoxels * (voxel / fine)), 0);
    }
    program_->set("levelRow", traced.row);
    program_->set("doubleSided", doubleSided);
    std::vector<Hit> hits;
    for (const glm::vec4& row : ShaderBench::run(*program_, inputs, rays.size(), 1))
      hits.push_back({row.x != 0, row.y, row.z != 0, row.w});
    return hits;
  }

  std::vector<std::unique_ptr<BrickField>> fields_;
  std::vector<Case> cases_;
  std::unique_ptr<BrickAtlas> atlas_;
  ShaderBench bench_;
  std::shared_ptr<Program> program_;
};

// Nothing where the ray misses the bounds.
std::optional<Ray> makeRay(const Case& traced, glm::vec3 origin, glm::vec3 direction) {
  const Box& box = traced.field->boundsObject;
  double tMin = 0, tMax = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double{box.min[axis]} - origin[axis], high = double{box.max[axis]} - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return {};
      continue;
    }
    tMin = std::max(tMin, std::min(low / direction[axis], high / direction[axis]));
    tMax = std::min(tMax, std::max(low / direction[axis], high / direction[axis]));
  }
  if (!(tMin < tMax)) return {};
  const double voxel = traced.bricks().voxelSizeObject;
  const glm::dvec3 entry = glm::dvec3(origin) + tMin * glm::dvec3(direction);
  return Ray{(entry - glm::dvec3(traced.field->originObject)) / voxel,
             glm::dvec3(direction) / voxel,
             origin,
             direction,
             tMin,
             tMax};
}

// From outside and inside, along axes, with zero components, grazing; of any length.
std::vector<Ray> makeRays(const Case& traced, std::size_t count, Random& random) {
  const Box wide = traced.field->boundsObject.expanded(1.0f);
  std::vector<Ray> rays;
  for (std::size_t i = 0; rays.size() < count; ++i) {
    const bool inside = i % 4 == 0;
    glm::vec3 origin = random.in(inside ? traced.field->boundsObject : wide);
    glm::vec3 direction = random.direction();
    if (!inside) direction = random.in(traced.field->boundsObject) - origin;
    if (i % 8 == 1 || i % 8 == 2) direction[static_cast<int>(i / 8 % 3)] = 0;
    if (i % 8 == 2) direction[static_cast<int>((i / 8 + 1) % 3)] = 0;
    if (i % 8 == 3) {
      // Along the surface: walk onto it, then turn into its tangent plane.
      glm::vec3 point = random.in(traced.body.surface);
      for (int step = 0; step < 8; ++step)
        point -= fieldNormal(*traced.field, 0, point) * sampleDistance(*traced.field, 0, point);
      direction = glm::cross(fieldNormal(*traced.field, 0, point), random.direction());
      origin = point - 3.0f * direction;
    }
    if (glm::length(direction) < 1e-3f) continue;
    direction *= random.between(0.2f, 5.0f) / glm::length(direction);
    if (const auto ray = makeRay(traced, origin, direction)) rays.push_back(*ray);
  }
  return rays;
}

std::vector<float> fullLengths(const std::vector<Ray>& rays) {
  std::vector<float> ends;
  for (const Ray& ray : rays) ends.push_back(static_cast<float>(ray.tEnd - ray.tEntry));
  return ends;
}

double alongRay(const Case& traced, const Ray& ray, double t) {
  return sampleVoxels(traced.bricks(), ray.entryVoxels + t * ray.stepVoxels);
}

// The lowest reconstructed distance before `end`, after an inside that the ray starts in is left.
double lowestBefore(const Case& traced, const Ray& ray, double end) {
  const double step = 0.2 / glm::length(ray.stepVoxels);
  bool outside = false;
  double lowest = 1e9;
  for (double t = 0; t < end; t += step) {
    const double d = alongRay(traced, ray, t);
    outside = outside || d > kEpsVoxels;
    if (outside) lowest = std::min(lowest, d);
  }
  return lowest;
}

TEST_F(BrickTrace, HitsLieOnTheFieldAndNothingIsPassed) {
  Random random(11);
  for (const Case& traced : cases_) {
    const auto rays = makeRays(traced, 1200, random);
    const auto hits = trace(traced, rays, fullLengths(rays));
    std::size_t hitCount = 0, outOfSteps = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double end = hits[i].hit ? hits[i].t : rays[i].tEnd - rays[i].tEntry;
      hitCount += hits[i].hit;
      if (hits[i].hit) {
        ASSERT_NEAR(alongRay(traced, rays[i], hits[i].t), 0, kEpsVoxels) << traced.name() << " ray " << i;
      }
      ASSERT_GE(lowestBefore(traced, rays[i], end), -kEpsVoxels) << traced.name() << " ray " << i << " t " << end;
      EXPECT_FALSE(hits[i].backFace);
      outOfSteps += hits[i].steps >= 2048;
    }
    // A ray nearly parallel to a voxel's border may creep along it by nudges, because rounding puts it on one side and
    // the exit on the other: seen once in 21,600.
    EXPECT_EQ(outOfSteps, 0u) << traced.name();
    EXPECT_GT(hitCount, rays.size() / 4) << traced.name();
    EXPECT_LT(hitCount, rays.size() * 19 / 20) << traced.name();
  }
}

// Where the field falls along the ray by s voxels a voxel, an error of eps in it moves the crossing by eps/s.
TEST_F(BrickTrace, HitsAreThoseOfTheTwin) {
  Random random(12);
  for (const Case& traced : cases_) {
    const auto rays = makeRays(traced, 1200, random);
    const auto hits = trace(traced, rays, fullLengths(rays));
    std::size_t compared = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      const auto twin = traceField(*traced.field, traced.level, ray.originObject, ray.directionObject, 0, 1e9f);
      if (!twin) continue;
      const double speed = glm::length(ray.stepVoxels), t = *twin - ray.tEntry, part = 0.02 / speed;
      const double slope = (alongRay(traced, ray, t - part) - alongRay(traced, ray, t + part)) / 0.04;
      if (slope < 0.05) continue;
      ++compared;
      ASSERT_TRUE(hits[i].hit || alongRay(traced, ray, t + part) > -kEpsVoxels) << traced.name() << " ray " << i;
      // A hit earlier than the twin's is a graze within eps, which the test above allows.
      if (hits[i].hit && hits[i].t > t - part) {
        // The twin's t is rounded to a float of up to 64.
        ASSERT_NEAR(hits[i].t * speed, t * speed, kEpsVoxels / slope + 4e-6 * speed) << traced.name() << " ray " << i;
      }
    }
    EXPECT_GT(compared, rays.size() / 5) << traced.name();
  }
}

TEST_F(BrickTrace, HitsLieOnTheClosedForm) {
  Random random(13);
  for (const Case& traced : cases_) {
    const auto rays = makeRays(traced, 1200, random);
    const auto hits = trace(traced, rays, fullLengths(rays));
    const float voxel = traced.bricks().voxelSizeObject;
    const auto slack = [&](glm::vec3 point) {
      return (trilinearErrorVoxels(traced.body, point, voxel) + codeVoxels(traced.bricks()) + floatErrorVoxels(voxel) +
              static_cast<float>(kEpsVoxels)) *
             voxel;
    };
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      const auto pointAt = [&](double t) {
        return glm::vec3(glm::dvec3(ray.originObject) + (ray.tEntry + t) * glm::dvec3(ray.directionObject));
      };
      if (hits[i].hit) {
        const glm::vec3 point = pointAt(hits[i].t);
        ASSERT_NEAR(traced.body.distance(point), 0, slack(point)) << traced.name() << " ray " << i;
      } else if (traced.body.distance(pointAt(0)) > 0) {
        const double end = ray.tEnd - ray.tEntry;
        for (int k = 0; k <= 64; ++k) {
          const glm::vec3 point = pointAt(end * k / 64);
          ASSERT_GE(traced.body.distance(point), -slack(point)) << traced.name() << " missed, ray " << i;
        }
      }
    }
  }
}

TEST_F(BrickTrace, EndOfTheRangeDecidesWhetherNotWhere) {
  Random random(14);
  for (const Case& traced : cases_) {
    const auto rays = makeRays(traced, 600, random);
    const auto full = trace(traced, rays, fullLengths(rays));
    std::vector<float> just = fullLengths(rays), beyond = just, before = just;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!full[i].hit) continue;
      just[i] = full[i].t;
      beyond[i] = full[i].t + random.unit() * 0.3f;
      before[i] = std::nextafter(full[i].t, -1.0f);
    }
    const auto atJust = trace(traced, rays, just), atBeyond = trace(traced, rays, beyond),
               atBefore = trace(traced, rays, before);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!full[i].hit) continue;
      ASSERT_TRUE(atJust[i].hit && atBeyond[i].hit) << traced.name() << " ray " << i;
      ASSERT_EQ(atJust[i].t, full[i].t) << traced.name() << " ray " << i;
      ASSERT_EQ(atBeyond[i].t, full[i].t) << traced.name() << " ray " << i;
      ASSERT_FALSE(atBefore[i].hit) << traced.name() << " ray " << i;
    }
  }
}

TEST_F(BrickTrace, DoubleSidedRaysFromInsideHitTheWayOut) {
  Random random(15);
  for (const Case& traced : cases_) {
    std::vector<Ray> rays;
    while (rays.size() < 200) {
      const glm::vec3 origin = random.in(traced.body.surface);
      if (sampleDistance(*traced.field, traced.level, origin) > -traced.bricks().voxelSizeObject) continue;
      if (const auto ray = makeRay(traced, origin, random.direction())) rays.push_back(*ray);
    }
    const auto hits = trace(traced, rays, fullLengths(rays), true);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(hits[i].hit && hits[i].backFace) << traced.name() << " ray " << i;
      ASSERT_NEAR(alongRay(traced, rays[i], hits[i].t), 0, kEpsVoxels) << traced.name() << " ray " << i;
      for (double t = 0; t < hits[i].t; t += 0.2 / glm::length(rays[i].stepVoxels))
        ASSERT_LE(alongRay(traced, rays[i], t), kEpsVoxels) << traced.name() << " ray " << i;
    }
  }
}

// Filter weights may have eight bits (OpenGL leaves it open; NVIDIA does): 1/512 off at most on each axis, whose
// samples differ by at most a voxel and two codes (8 bits: 1.063). Three axes: 0.0063; positions add 1e-4.
TEST_F(BrickTrace, DistanceAndGradientAreTheTwins) {
  constexpr double kFilterVoxels = 0.0065;
  const auto program = bench_.load("#include \"lib/bricks.glsl\"\nuniform uint levelRow;", R"(
  vec3 p = inputs[index].xyz;
  outputs[index] = vec4(fieldGradient(sdfLevels[levelRow], p, 0.5), fieldDistance(sdfLevels[levelRow], p));)");
  Random random(16);
  for (const Case& traced : cases_) {
    const double voxel = traced.bricks().voxelSizeObject;
    const glm::vec3 origin = traced.field->originObject;
    std::vector<glm::vec4> inputs;
    std::vector<glm::vec3> points;
    for (int i = 0; i < 1200; ++i) {
      glm::vec3 point = random.in(traced.field->boundsObject);
      if (i % 2) point -= fieldNormal(*traced.field, 0, point) * sampleDistance(*traced.field, 0, point);
      points.push_back(point);
      inputs.emplace_back(glm::vec3((glm::dvec3(point) - glm::dvec3(origin)) / voxel), 0);
    }
    program->set("levelRow", traced.row);
    const auto outputs = ShaderBench::run(*program, inputs, points.size(), 1);
    std::size_t normals = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      // Cell borders separate bounds from distances: within a rounding of one, either twin may be on either side.
      bool nearBorder = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const float offset : {-0.5f, 0.0f, 0.5f}) {
          const float inBrick = (inputs[i][axis] + offset) / kBrickCells;
          nearBorder = nearBorder || std::abs(inBrick - std::round(inBrick)) < 1e-4f;
        }
      if (nearBorder) continue;
      const double expected = sampleDistance(*traced.field, traced.level, points[i]) / voxel;
      ASSERT_NEAR(outputs[i].w, expected, kFilterVoxels) << traced.name() << " point " << i;
      glm::dvec3 gradient;
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 half(0);
        half[axis] = 0.5;
        const glm::dvec3 p(inputs[i]);
        gradient[axis] = sampleVoxels(traced.bricks(), p + half) - sampleVoxels(traced.bricks(), p - half);
        ASSERT_NEAR(outputs[i][axis], gradient[axis], 2 * kFilterVoxels) << traced.name() << " point " << i;
      }
      const double length = glm::length(gradient);
      if (length < 0.3) continue;
      ++normals;
      const glm::vec3 normal = glm::normalize(glm::vec3(outputs[i]));
      ASSERT_LT(glm::distance(normal, fieldNormal(*traced.field, traced.level, points[i])),
                2 * 1.7320508 * 2 * kFilterVoxels / length)
          << traced.name() << " point " << i;
    }
    EXPECT_GT(normals, points.size() / 4) << traced.name();
  }
}

} // namespace
} // namespace brickfield::test
