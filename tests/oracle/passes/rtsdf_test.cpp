// The fine field against a twin of equation 1 whose rays are Embree's, against the true distance, and against what is
// known of the method: its convergence by rays alone and its two faults.
#include <algorithm>
#include <tuple>

#include "core/error.h"
#include "tests/oracle/passes/rtsdf_stage.h"
#include "tests/support/data.h"
#include "tests/support/embree_rays.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

glm::uvec4 hashOf(glm::uvec4 v) {
  v = v * 1664525u + 1013904223u;
  const auto mix = [&v] { v.x += v.y * v.w, v.y += v.z * v.x, v.z += v.x * v.y, v.w += v.y * v.z; };
  mix();
  v ^= v >> 16u;
  mix();
  return v;
}

glm::vec3 randomDirection(std::uint32_t texel, std::uint32_t ray, std::uint32_t frame, std::uint32_t seed) {
  const glm::uvec4 hash = hashOf({texel, ray, frame, seed});
  const double x = ((hash.x >> 8) + 0.5) / 16777216.0, y = ((hash.y >> 8) + 0.5) / 16777216.0;
  const double height = 1 - 2 * x, radius = std::sqrt(std::max(0.0, 1 - height * height));
  const double angle = 6.283185307179586 * y;
  return {radius * std::cos(angle), radius * std::sin(angle), height};
}

/// Value of the coarse field at a centre of a fine texel, by the rules of trilinear filtering clamped to the edge.
double coarseAt(const RtsdfField& field, const std::vector<float>& coarse, glm::ivec3 place) {
  const int size = field.settings().coarseSize;
  const glm::dvec3 at =
      (glm::dvec3(place) + 0.5) * static_cast<double>(size) / static_cast<double>(field.settings().fineSize) - 0.5;
  const glm::ivec3 corner(glm::floor(at));
  const glm::dvec3 part = at - glm::dvec3(corner);
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 step(i & 1, i >> 1 & 1, i >> 2);
    const glm::ivec3 p = glm::clamp(corner + step, glm::ivec3(0), glm::ivec3(size - 1));
    const glm::dvec3 weight = glm::mix(1.0 - part, part, glm::dvec3(step));
    sum += weight.x * weight.y * weight.z * double{coarse[static_cast<std::size_t>((p.z * size + p.y) * size + p.x)]};
  }
  return sum;
}

struct ErrorNearSurface {
  double rms = 0, mean = 0, least = 0; ///< texels, over those within four of the surface, of unsigned distances
  std::size_t wrongSigns = 0, count = 0;
};

Mesh smallTorus() { return makeTorusMesh(0.6f, 0.3f, 32, 16); }

class Rtsdf : public GlTest {
protected:
  static ErrorNearSurface errorOf(RtsdfStage& stage, const EmbreeRays& oracle) {
    const std::vector<float> distances = stage.field().readDistances();
    ErrorNearSurface error;
    stage.forEachTexel([&](std::size_t i, glm::ivec3 place) {
      const glm::vec3 center = stage.centerAnchored(place);
      const double truth = oracle.distance(center) * stage.field().cascade().texel.y;
      if (truth > 4) return;
      const double apart = std::min(std::abs(static_cast<double>(distances[i])), 1e3) - truth;
      error.rms += apart * apart;
      error.mean += apart;
      error.least = std::min(error.least, apart);
      // The torus' tube: inside is within its radius of the circle. Facets cut that by less than 0.02 of the radius.
      const double outOfCircle = glm::length(glm::vec2(glm::length(glm::vec2(center)) - 0.6f, center.z)) - 0.3;
      if (std::abs(outOfCircle) > 0.01 && (distances[i] < 0) != (outOfCircle < 0)) ++error.wrongSigns;
      ++error.count;
    });
    error.rms = std::sqrt(error.rms / static_cast<double>(error.count));
    error.mean /= static_cast<double>(error.count);
    return error;
  }
};

RtsdfSettings smallSettings() {
  RtsdfSettings settings;
  settings.coarseSize = 16;
  settings.fineSize = 32;
  settings.raysPerTexel = 3;
  settings.maskWidth = 0.4f;
  settings.seed = 9;
  return settings;
}

// Three frames, texel by texel: inside the mask equation 1 and the votes, outside of it c and no votes.
TEST_F(Rtsdf, FramesFollowEquationOne) {
  const RtsdfSettings settings = smallSettings();
  MeshAlone torus(smallTorus());
  RtsdfStage stage(settings, torus.posed, torus.trees);
  const EmbreeRays oracle(torus.posed.rows);
  std::vector<double> shortest, votes;
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    stage.recordFrame();
    const RtsdfField& field = stage.field();
    const std::vector<float> coarse = field.coarse().readFloats();
    const std::vector<float> actual = field.shortest().read<float>(), actualVotes = field.votes().read<float>();
    shortest.resize(actual.size());
    votes.resize(actual.size());
    std::size_t masked = 0, unmasked = 0, off = 0;
    stage.forEachTexel([&](std::size_t i, glm::ivec3 place) {
      const double c = coarseAt(field, coarse, place);
      if (std::abs(c - 0.2 * 32) < 1e-4) return; // on the mask's side by rounding
      if (std::abs(c) > 0.2 * 32) {
        ++unmasked;
        EXPECT_NEAR(actual[i], c, 1e-4);
        EXPECT_EQ(actualVotes[i], 0);
        shortest[i] = actual[i], votes[i] = 0;
        return;
      }
      ++masked;
      double nearest = std::numeric_limits<double>::infinity(), vote = 0;
      for (std::uint32_t ray = 0; ray < 3; ++ray) {
        const OracleHit hit = oracle.trace(stage.centerAnchored(place),
                                           randomDirection(static_cast<std::uint32_t>(i), ray, frame, settings.seed));
        if (std::isinf(hit.distance)) continue;
        nearest = std::min(nearest, double{hit.distance} * field.cascade().texel.y);
        vote += hit.isFront ? 1 : -1;
      }
      const double before = frame == 0 ? c : shortest[i];
      const double expected = std::min(0.95 * before + 0.05 * c, nearest);
      const double expectedVotes = (frame == 0 ? 0 : 0.95 * votes[i]) + vote;
      // Directions differ by floats' sines, 1e-6; along grazing rays distances by more, so a few texels are let off.
      if (std::abs(expected - actual[i]) > 1e-3 || std::abs(expectedVotes - actualVotes[i]) > 1e-4) ++off;
      shortest[i] = actual[i], votes[i] = actualVotes[i]; // each frame stands for itself
    });
    EXPECT_GT(masked, 5000u);
    EXPECT_GT(unmasked, 5000u);
    EXPECT_LE(static_cast<double>(off), 0.001 * static_cast<double>(masked)) << "frame " << frame;
  }
}

TEST_F(Rtsdf, TwoRunsAreTheSameBytesAndAnotherSeedIsNot) {
  MeshAlone torus(smallTorus());
  const auto run = [&](std::uint32_t seed) {
    RtsdfSettings settings = smallSettings();
    settings.seed = seed;
    RtsdfStage stage(settings, torus.posed, torus.trees);
    stage.recordFrame();
    stage.recordFrame();
    const RtsdfField& field = stage.field();
    return std::tuple(field.volume().read<std::uint16_t>(), field.shortest().read<std::uint32_t>(),
                      field.votes().read<std::uint32_t>());
  };
  const auto first = run(1), again = run(1), other = run(2);
  EXPECT_TRUE(first == again);
  EXPECT_FALSE(std::get<2>(first) == std::get<2>(other));
}

// The volume is the field less its bias, each texel at its place in the lattice.
TEST_F(Rtsdf, VolumeHoldsTheBiasedFieldInItsSlots) {
  MeshAlone torus(smallTorus());
  RtsdfSettings settings = smallSettings();
  settings.bias = 0.1f;
  for (const bool bruteForce : {false, true}) {
    settings.bruteForce = bruteForce;
    settings.bruteExtent = {25, 13, 22};
    RtsdfStage stage(settings, torus.posed, torus.trees, {{-1.3f, -0.7f, -0.5f}, {0.9f, 1.1f, 0.8f}});
    stage.recordFrame();
    const RtsdfField& field = stage.field();
    const glm::ivec3 extent = field.extent(), window(field.cascade().window);
    EXPECT_NE(window, glm::ivec3(0));
    const std::vector<float> volume = field.volume().readFloats(), distances = field.readDistances();
    const float bias = 0.05f * static_cast<float>(bruteForce ? 25 : 32);
    stage.forEachTexel([&](std::size_t i, glm::ivec3 place) {
      glm::ivec3 slot;
      for (int axis = 0; axis < 3; ++axis)
        slot[axis] = ((place[axis] + window[axis]) % extent[axis] + extent[axis]) % extent[axis];
      const float stored = volume[static_cast<std::size_t>((slot.z * extent.y + slot.y) * extent.x + slot.x)];
      const float expected = std::min(distances[i] - bias, field.cascade().texel.z);
      EXPECT_NEAR(stored, expected, 1e-5f + 1e-3f * std::abs(expected)) << i; // 11 bits
    });
  }
}

TEST_F(Rtsdf, WindowFarFromTheAnchorIsAsFineAsFloats) {
  RtsdfField field(smallSettings());
  field.place({{1e9f, -1e9f, 0}, {1e9f + 64, -1e9f + 64, 1}});
  EXPECT_FLOAT_EQ(field.cascade().texel.x, std::ldexp(1e9f, -22));
  EXPECT_NEAR(field.originAnchored().x, 1e9, 32 * 1e9 / (1 << 22));
  EXPECT_NEAR(field.originAnchored().y, -1e9, 32 * 1e9 / (1 << 22));
}

// The window holds the box with its margin, and its texels are as small as that allows.
TEST_F(Rtsdf, WindowCoversTheScene) {
  for (const Box& box : {Box{{-1.3f, -0.7f, -0.5f}, {0.9f, 1.1f, 0.8f}}, Box{{1e4f, 2, 3}, {1e4f + 1, 3, 4}},
                         Box{{0.001f, 0, 0}, {0.011f, 0.002f, 0.003f}}, Box{{5, 5, 5}, {5, 5, 5}}, Box()}) {
    RtsdfSettings settings = smallSettings();
    RtsdfField field(settings);
    field.place(box);
    const float texel = field.cascade().texel.x;
    EXPECT_GT(texel, 0);
    EXPECT_FLOAT_EQ(field.cascade().texel.y, 1 / texel);
    if (box.isEmpty()) continue;
    const glm::vec3 last = field.originAnchored() + glm::vec3(field.extent()) * texel;
    const float rounding = 1e-6f * glm::length(box.center());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(field.originAnchored()[axis], box.min[axis] - 1.99f * texel + rounding);
      EXPECT_GE(last[axis], box.max[axis] + 1.99f * texel - rounding);
    }
    const glm::vec3 extent = box.extent();
    const float longest = std::max({extent.x, extent.y, extent.z});
    EXPECT_TRUE(longest == 0 || texel <= longest / (32 - 2 * 2 - 1) * 1.0001f) << texel;
  }
}

TEST_F(Rtsdf, BruteForceConvergesToTheTruth) {
  MeshAlone torus(smallTorus());
  RtsdfSettings settings = smallSettings();
  settings.bruteForce = true;
  settings.bruteExtent = {24, 24, 12};
  settings.raysPerTexel = 16;
  RtsdfStage stage(settings, torus.posed, torus.trees);
  const EmbreeRays oracle(torus.posed.rows);
  stage.recordFrame();
  const ErrorNearSurface first = errorOf(stage, oracle);
  for (int frame = 1; frame < 16; ++frame) stage.recordFrame();
  const ErrorNearSurface last = errorOf(stage, oracle);
  ASSERT_GT(last.count, 1000u);
  EXPECT_GE(last.least, -1e-3); // what a ray hits is no nearer than the nearest
  EXPECT_GT(first.rms, 0.2);
  // A ray within an angle a of the nearest point's direction is at most 1 / cos a too long on a plane: of n rays the
  // best has 1 - cos a = 2 / n on average, so at 256 rays and 2 texels (the middle of the band) 0.016; edges and curves
  // cost some more.
  EXPECT_LT(last.rms, 0.06);
  EXPECT_EQ(last.wrongSigns, 0u);
}

// The tube is hollow again; outside of it nothing changes.
TEST_F(Rtsdf, WithoutVoteNothingIsInside) {
  MeshAlone torus(smallTorus());
  RtsdfSettings settings = smallSettings();
  settings.bias = 0;
  RtsdfStage voted(settings, torus.posed, torus.trees);
  settings.signByVote = false;
  RtsdfStage hollow(settings, torus.posed, torus.trees);
  std::size_t turned = 0;
  for (RtsdfStage* stage : {&voted, &hollow}) stage->recordFrame();
  const std::vector<float> votedDistances = voted.field().readDistances();
  const std::vector<float> distances = hollow.field().readDistances(), volume = hollow.field().volume().readFloats();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    EXPECT_EQ(std::abs(distances[i]), std::abs(votedDistances[i]));
    EXPECT_GE(distances[i], -0.21f); // beta
    turned += distances[i] != votedDistances[i];
  }
  EXPECT_GT(turned, 500u);
  EXPECT_GE(*std::min_element(volume.begin(), volume.end()), -0.21f);
}

// Known fault: a coarse distance is too short by up to half a coarse voxel's diagonal and beta, and the minimum keeps
// it.
TEST_F(Rtsdf, CoarseDistancesThatAreTooShortStayHoweverManyRays) {
  MeshAlone torus(smallTorus());
  RtsdfSettings settings = smallSettings();
  const EmbreeRays oracle(torus.posed.rows);
  ErrorNearSurface errors[2];
  for (const bool many : {false, true}) {
    settings.raysPerTexel = many ? 64 : 8;
    RtsdfStage stage(settings, torus.posed, torus.trees);
    for (int frame = 0; frame < 4; ++frame) stage.recordFrame();
    errors[many] = errorOf(stage, oracle);
  }
  // An earlier study of this formula, on other scenes, found 1.03 fine texels, however many rays.
  for (const ErrorNearSurface& error : errors) {
    EXPECT_GT(error.rms, 0.6);
    EXPECT_LT(error.rms, 1.5);
    EXPECT_LT(error.mean, -0.4);
    // A seed's centre is half a coarse voxel's diagonal off at most, beta less; interpolation cuts ridges by half a
    // one.
    EXPECT_GE(error.least, -(std::sqrt(3.0) + 0.2 + 1));
  }
  EXPECT_NEAR(errors[0].rms, errors[1].rms, 0.05);
}

MeshAlone sphereAt(glm::vec3 center) {
  Mesh mesh = makeSphereMesh(0.2f, 12, 24);
  for (glm::vec3& position : mesh.primitives[0].positions) position += center;
  return MeshAlone(mesh);
}

// Known fault: what a thing has left is not empty at once. Without rays equation 1 is f = c + alpha^n (f0 - c).
TEST_F(Rtsdf, GhostsFadeByAlphaWithinTheMask) {
  const Box box{glm::vec3(-1), glm::vec3(1)};
  const glm::vec3 from(-0.5f, 0, 0);
  MeshAlone before = sphereAt(from), after = sphereAt({0.5f, 0, 0});
  RtsdfSettings settings = smallSettings();
  settings.raysPerTexel = 0;
  settings.maskWidth = std::numeric_limits<float>::infinity();
  RtsdfStage stage(settings, before.posed, before.trees, box);
  stage.recordFrame();
  const std::vector<float> left = stage.field().readDistances();
  stage.move(after.posed);
  constexpr int kFrames = 5;
  for (int frame = 0; frame < kFrames; ++frame) stage.recordFrame();
  const std::vector<float> ghost = stage.field().readDistances(), coarse = stage.field().coarse().readFloats();
  std::size_t ghosts = 0;
  stage.forEachTexel([&](std::size_t i, glm::ivec3 place) {
    const double c = coarseAt(stage.field(), coarse, place);
    EXPECT_NEAR(ghost[i], c + std::pow(0.95, kFrames) * (left[i] - c), 1e-3);
    if (glm::distance(stage.centerAnchored(place), from) < 0.2f) {
      EXPECT_LT(ghost[i], 0.5 * c); // the thing is a metre away
      ++ghosts;
    }
  });
  EXPECT_GT(ghosts, 30u);
}

TEST_F(Rtsdf, NothingGhostsOutsideTheMask) {
  const Box box{glm::vec3(-1), glm::vec3(1)};
  const glm::vec3 from(-0.5f, 0, 0);
  MeshAlone before = sphereAt(from), after = sphereAt({0.5f, 0, 0});
  RtsdfSettings settings = smallSettings();
  settings.maskWidth = 0.1f;
  RtsdfStage stage(settings, before.posed, before.trees, box);
  stage.recordFrame();
  stage.move(after.posed);
  stage.recordFrame();
  const std::vector<float> field = stage.field().readDistances(), coarse = stage.field().coarse().readFloats();
  stage.forEachTexel([&](std::size_t i, glm::ivec3 place) {
    if (glm::distance(stage.centerAnchored(place), from) > 0.3f) return;
    EXPECT_NEAR(field[i], coarseAt(stage.field(), coarse, place), 1e-4);
  });
}

TEST_F(Rtsdf, SizeBeyondTheDriversReachIsRefused) {
  GLint64 most = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (most >= GLint64{512} * 512 * 512 * 4) return reportNotRun("this driver's shaders reach all sizes");
  RtsdfSettings settings;
  setRtsdfSize(settings, "L");
  EXPECT_THROW(RtsdfField field(settings), BadInput);
}

// What is laid anew starts anew.
TEST_F(Rtsdf, AnotherWindowForgets) {
  MeshAlone torus(smallTorus());
  RtsdfStage stage(smallSettings(), torus.posed, torus.trees);
  stage.recordFrame();
  const auto fresh = stage.field().shortest().read<float>();
  stage.recordFrame();
  EXPECT_NE(stage.field().shortest().read<float>(), fresh);
  stage.field().place(torus.posed.bounds);
  EXPECT_EQ(stage.field().frame(), 2u); // the same window
  stage.field().place(torus.posed.bounds.expanded(0.2f));
  EXPECT_EQ(stage.field().frame(), 0u);
  stage.field().place(torus.posed.bounds);
  stage.recordFrame();
  EXPECT_EQ(stage.field().shortest().read<float>(), fresh);
}

TEST_F(Rtsdf, CountsWhatItDid) {
  MeshAlone torus(smallTorus());
  RtsdfSettings settings = smallSettings();
  RtsdfStage plain(settings, torus.posed, torus.trees), counting(settings, torus.posed, torus.trees);
  plain.recordFrame();
  const RtsdfCounts counts = counting.recordCounting();
  EXPECT_EQ(plain.field().shortest().read<float>(), counting.field().shortest().read<float>());
  const std::vector<float> coarse = plain.field().coarse().readFloats();
  std::uint64_t masked = 0;
  plain.forEachTexel([&](std::size_t, glm::ivec3 place) {
    if (std::abs(coarseAt(plain.field(), coarse, place)) <= 0.2 * 32) ++masked;
  });
  EXPECT_NEAR(static_cast<double>(counts.texels), static_cast<double>(masked), 0.001 * static_cast<double>(masked));
  EXPECT_EQ(counts.rays, counts.texels * 3);
  EXPECT_GT(counts.hits, counts.rays / 10);
  EXPECT_LT(counts.hits, counts.rays);
  EXPECT_GT(counts.nodeVisits, counts.rays);
  EXPECT_LT(counts.nodeVisits, counts.rays * 60);
  EXPECT_GT(counts.triangleTests, counts.hits);
}

} // namespace
} // namespace brickfield::test
