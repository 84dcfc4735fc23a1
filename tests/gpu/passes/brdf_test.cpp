// Functions of shaders/lib against their C++ twins at random arguments: shading, harmonics, environment directions,
// tone curve, octahedral vectors.
#include <random>

#include "app/tone_curve.h"
#include "core/math.h"
#include "scene/brdf.h"
#include "scene/environment.h"
#include "scene/lighting.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class Random {
public:
  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_() >> 8) / static_cast<float>(1u << 24);
  }
  glm::vec3 color() { return {between(0, 1), between(0, 1), between(0, 1)}; }
  glm::vec3 direction() {
    const float z = between(-1, 1), angle = between(0, 6.2831853f), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

private:
  std::mt19937 engine_{7};
};

// Six axes, twelve edges and eight corners, then random ones.
std::vector<glm::vec3> directions(Random& random, std::size_t count) {
  std::vector<glm::vec3> all;
  for (const float x : {-1.0f, 0.0f, 1.0f})
    for (const float y : {-1.0f, 0.0f, 1.0f})
      for (const float z : {-1.0f, 0.0f, 1.0f})
        if (x != 0 || y != 0 || z != 0) all.push_back(glm::normalize(glm::vec3(x, y, z)));
  while (all.size() < count) all.push_back(random.direction());
  return all;
}

class ShaderTwins : public GlTest {
protected:
  ShaderBench bench_;
  Random random_;
};

// Normalizing, powers and divisions of the two differ by some roundings each; GGX's peak multiplies those of n.h by
// 4/alpha^2 at most: 1 - n.h of 1e-7 against alpha^2 / 4.
TEST_F(ShaderTwins, ReflectedShareIsTheBrdfTimesTheCosine) {
  const auto program = bench_.load("#include \"lib/brdf.glsl\"", R"(
  vec4 a = inputs[index * 4u], n = inputs[index * 4u + 1u], v = inputs[index * 4u + 2u], l = inputs[index * 4u + 3u];
  outputs[index] = vec4(reflectedShare(Surface(a.rgb, a.w, n.w, 0.0), n.xyz, v.xyz, l.xyz), 0.0);)");
  constexpr std::size_t kCount = 20000;
  std::vector<glm::vec4> inputs;
  for (std::size_t i = 0; i < kCount; ++i) {
    const glm::vec3 n = random_.direction();
    const glm::vec3 v = random_.direction();
    // A third near the mirror direction, where the highlight is; a few viewers lie below the horizon.
    const glm::vec3 mirrored = glm::reflect(-v, n);
    const glm::vec3 l = i % 3 ? random_.direction() : glm::normalize(mirrored + 0.1f * random_.direction());
    const float roughness = i % 5 ? random_.between(0, 1) : 0.0f;
    inputs.insert(inputs.end(), {glm::vec4(random_.color(), random_.between(0, 1)), glm::vec4(n, roughness),
                                 glm::vec4(v, 0), glm::vec4(l, 0)});
  }
  const auto outputs = ShaderBench::run(*program, inputs, kCount, 1);
  std::size_t lit = 0, below = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const glm::vec4 a = inputs[4 * i], n = inputs[4 * i + 1], v = inputs[4 * i + 2], l = inputs[4 * i + 3];
    const SurfaceBrdf brdf = makeBrdf(glm::vec3(a), a.w, n.w);
    const float cosine = std::max(0.0f, glm::dot(glm::vec3(n), glm::vec3(l)));
    const glm::vec3 expected = evaluateBrdf(brdf, glm::vec3(n), glm::vec3(v), glm::vec3(l)) * cosine;
    lit += expected.x > 0;
    below += expected.x > 0 && glm::dot(glm::vec3(n), glm::vec3(v)) < 0;
    const float relative = 2e-5f + 4e-6f / (brdf.alpha * brdf.alpha);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(outputs[i][c], expected[c], std::max(1e-6f, std::min(relative, 0.2f) * expected[c]))
          << "case " << i << " alpha " << brdf.alpha << " n.v " << glm::dot(glm::vec3(n), glm::vec3(v));
  }
  EXPECT_GT(lit, kCount / 3);
  EXPECT_GT(below, kCount / 20);
}

// A power of s takes n.h's rounding of 1e-7 s times, and GPUs take powers by 2^(s log2 x), whose log2 is off by 1e-6 or
// so.
TEST_F(ShaderTwins, BlinnPhongShareIsTheTwinTimesTheCosine) {
  const auto program = bench_.load("#include \"lib/brdf.glsl\"", R"(
  vec4 a = inputs[index * 4u], n = inputs[index * 4u + 1u], v = inputs[index * 4u + 2u], l = inputs[index * 4u + 3u];
  outputs[index] = vec4(blinnPhongShare(Surface(a.rgb, a.w, n.w, 0.0), n.xyz, v.xyz, l.xyz), 0.0);)");
  constexpr std::size_t kCount = 20000;
  std::vector<glm::vec4> inputs;
  for (std::size_t i = 0; i < kCount; ++i) {
    const glm::vec3 n = random_.direction(), v = random_.direction(), mirrored = glm::reflect(-v, n);
    const glm::vec3 l = i % 3 ? random_.direction() : glm::normalize(mirrored + 0.1f * random_.direction());
    const float roughness = i % 7 == 0 ? 1.0f : random_.between(0.1f, 1);
    inputs.insert(inputs.end(), {glm::vec4(random_.color(), random_.between(0, 1)), glm::vec4(n, roughness),
                                 glm::vec4(v, 0), glm::vec4(l, 0)});
  }
  const auto outputs = ShaderBench::run(*program, inputs, kCount, 1);
  std::size_t lit = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const glm::vec4 a = inputs[4 * i], n = inputs[4 * i + 1], v = inputs[4 * i + 2], l = inputs[4 * i + 3];
    const SurfaceBrdf brdf = makeBrdf(glm::vec3(a), a.w, n.w);
    const float cosine = std::max(0.0f, glm::dot(glm::vec3(n), glm::vec3(l)));
    const glm::vec3 expected = evaluateBlinnPhong(brdf, glm::vec3(n), glm::vec3(v), glm::vec3(l)) * cosine;
    lit += expected.x > 0;
    const float relative = 2e-5f + 2e-6f * blinnPhongExponent(brdf.alpha);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(outputs[i][c], expected[c], std::max(1e-6f, relative * expected[c])) << i << " alpha " << brdf.alpha;
  }
  EXPECT_GT(lit, kCount / 3);
}

TEST_F(ShaderTwins, LobesAreTheTwins) {
  const auto program = bench_.load("#include \"lib/brdf.glsl\"", R"(
  vec4 a = inputs[index];
  outputs[index * 2u] = vec4(distributionGgx(a.x, a.w), visibilitySmith(a.y, a.x, a.w), alphaOfRoughness(a.w), 0.0);
  outputs[index * 2u + 1u] = vec4(fresnelSchlick(a.xyz, a.w), 0.0);)");
  std::vector<glm::vec4> inputs;
  for (int i = 0; i < 4000; ++i) inputs.emplace_back(random_.color(), random_.between(0.05f, 1));
  inputs.emplace_back(-0.3f, 0.5f, 0.2f, 0.4f); // below the horizon
  const auto outputs = ShaderBench::run(*program, inputs, inputs.size(), 2);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec4 a = inputs[i];
    const float peak = distributionGgx(a.w, a.x);
    EXPECT_NEAR(outputs[2 * i].x, peak, 1e-5f * peak * (1 + 1 / (a.w * a.w)));
    if (a.x > 0) {
      const float visibility = visibilitySmith(a.w, a.y, a.x);
      EXPECT_NEAR(outputs[2 * i].y, visibility, 1e-5f * visibility);
    }
    EXPECT_NEAR(outputs[2 * i].z, makeBrdf(glm::vec3(1), 0, a.w).alpha, 1e-6f);
    const glm::vec3 fresnel = fresnelSchlick(glm::vec3(a), a.w);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(outputs[2 * i + 1][c], fresnel[c], 2e-6f);
  }
}

TEST_F(ShaderTwins, HarmonicsAreTheTwins) {
  const auto program = bench_.load("#include \"lib/spherical_harmonics.glsl\"", R"(
  vec4 coefficients[9];
  for (uint i = 0u; i < 9u; ++i) coefficients[i] = inputs[i];
  outputs[index] = vec4(evaluateHarmonics(coefficients, inputs[9u + index].xyz), 0.0);)");
  std::array<glm::vec3, 9> harmonics;
  std::vector<glm::vec4> inputs;
  for (glm::vec3& c : harmonics) {
    c = random_.color() * 2.0f - 0.8f;
    inputs.emplace_back(c, 0);
  }
  const auto all = directions(random_, 4000);
  for (const glm::vec3& d : all) inputs.emplace_back(d, 0);
  const auto outputs = ShaderBench::run(*program, inputs, all.size(), 1);
  std::size_t clamped = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const glm::vec3 expected = glm::max(evaluateHarmonics(harmonics, all[i]), glm::vec3(0)); // as its users do
    clamped += expected.x == 0;
    // Nine products of at most 1.1 * 1.2 with constants of six digits (5e-7 each).
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(outputs[i][c], expected[c], 1e-5f);
  }
  EXPECT_GT(clamped, 0u) << "no direction tried the clamp";
}

TEST_F(ShaderTwins, EnvironmentDirectionsAreTheTwins) {
  const auto program = bench_.load("#include \"lib/environment.glsl\"", R"(
  vec4 a = inputs[index];
  vec2 uv = equirectFromDirection(a.xyz);
  outputs[index * 2u] = vec4(uv, 0.0, 0.0);
  outputs[index * 2u + 1u] = vec4(directionFromEquirect(uv), 0.0);)");
  const auto all = directions(random_, 20000);
  std::vector<glm::vec4> inputs;
  for (const glm::vec3& d : all) inputs.emplace_back(d, 0);
  const auto outputs = ShaderBench::run(*program, inputs, all.size(), 2);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const glm::vec2 uv(outputs[2 * i]);
    const glm::vec2 expected = environmentUv(all[i]);
    // A GPU's acos and atan may be off by 2^-11 or so near the poles and the axes (OpenGL asks for nothing; Vulkan for
    // 4096 ulp): a hundredth of a texel of a picture of 1024 columns is 1e-5, and twenty times that is allowed. The
    // picture closes at u = 0 = 1, and at the poles u says nothing.
    const float du = std::abs(uv.x - expected.x), aroundPole = std::sqrt(1 - all[i].y * all[i].y);
    ASSERT_LT(std::min(du, std::abs(1 - du)) * aroundPole, 2e-4f) << i;
    ASSERT_NEAR(uv.y, expected.y, 2e-4f) << i;
    const glm::vec3 back(outputs[2 * i + 1]);
    ASSERT_LT(glm::distance(back, glm::vec3(environmentDirection(uv))), 1e-3f) << i;
    ASSERT_LT(glm::distance(back, all[i]), 2e-3f) << i;
  }
}

TEST_F(ShaderTwins, ToneCurveAndSrgbAreTheTwins) {
  const auto program = bench_.load("#include \"lib/tone_curve.glsl\"", R"(
  vec3 x = inputs[index].xyz;
  vec3 curve = filmicCurve(x);
  outputs[index * 2u] = vec4(curve, 0.0);
  outputs[index * 2u + 1u] = vec4(srgbFromLinear(curve), 0.0);)");
  std::vector<glm::vec4> inputs;
  for (int i = -200; i <= 200; ++i) inputs.emplace_back(glm::vec3(std::exp2(static_cast<float>(i) * 0.1f)), 0);
  inputs.emplace_back(0);
  inputs.emplace_back(glm::vec3(65504.0f * 1048576.0f), 0);
  inputs.emplace_back(glm::vec3(1e30f), 0); // its square is infinite
  inputs.emplace_back(glm::vec3(std::numeric_limits<float>::infinity()), 0);
  const auto outputs = ShaderBench::run(*program, inputs, inputs.size(), 2);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    // A tenth of a code of 8 bits: the picture may differ by one code only where rounding does.
    EXPECT_NEAR(outputs[2 * i].x, toneCurve(inputs[i].x), 1e-5f) << inputs[i].x;
    EXPECT_NEAR(outputs[2 * i + 1].y, displayFromRadiance(glm::vec3(inputs[i]), 0).y, 4e-4f) << inputs[i].x;
  }
}

TEST_F(ShaderTwins, OctahedralVectorsAreTheTwins) {
  const auto program = bench_.load("#include \"lib/octahedral.glsl\"", R"(
  vec2 coded = octahedralFromDirection(inputs[index].xyz);
  outputs[index * 2u] = vec4(coded, 0.0, 0.0);
  outputs[index * 2u + 1u] = vec4(directionFromOctahedral(coded), 0.0);)");
  const auto all = directions(random_, 20000);
  std::vector<glm::vec4> inputs;
  for (const glm::vec3& d : all) inputs.emplace_back(d, 0);
  const auto outputs = ShaderBench::run(*program, inputs, all.size(), 2);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const glm::vec2 expected = octahedralFromDirection(all[i]);
    ASSERT_LT(glm::distance(glm::vec2(outputs[2 * i]), expected), 1e-6f) << i;
    ASSERT_LT(glm::distance(glm::vec3(outputs[2 * i + 1]), all[i]), 2e-6f) << i;
  }
}

} // namespace
} // namespace brickfield::test
