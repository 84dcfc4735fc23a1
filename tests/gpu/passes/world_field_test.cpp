// lib/world_field.glsl against its twin on the CPU, over volumes made by hand: cascades whose windows lie anywhere on
// the lattice, and one whole volume that is no cube.
#include <random>

#include <fmt/format.h>

#include "field/field_volume.h"
#include "gpu/texture.h"
#include "shared/world_field_params.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

struct Ball {
  glm::dvec3 center;
  double radius;
};
// Two balls that reach through the windows' borders and one inside; nodes 4, 5 and 6.
const std::vector<Ball> kBalls{{{0.9, 0.2, -0.4}, 0.55}, {{-1.9, 0.3, 0.2}, 0.8}, {{0.1, -0.5, 0.6}, 0.2}};

// What an exact field holds: signed, ended at the range and at the border.
FieldVolume makeVolume(glm::ivec3 firstTexel, glm::ivec3 extent, double texelSize, float range, bool isWhole) {
  FieldVolume volume{firstTexel, extent, texelSize, range, isWhole, {}, {}};
  for (int z = 0; z < extent.z; ++z)
    for (int y = 0; y < extent.y; ++y)
      for (int x = 0; x < extent.x; ++x) {
        const glm::ivec3 at(x, y, z), fromEnd = extent - 1 - at;
        const glm::dvec3 point = (glm::dvec3(firstTexel + at) + 0.5) * texelSize;
        double nearest = 1e9;
        std::uint32_t node = 0;
        for (std::size_t i = 0; i < kBalls.size(); ++i) {
          const double distance = glm::distance(point, kBalls[i].center) - kBalls[i].radius;
          if (distance < nearest) nearest = distance, node = static_cast<std::uint32_t>(i) + 5;
        }
        double texels = std::clamp(nearest / texelSize, -double{range}, double{range});
        const int side = std::min({x, y, z, fromEnd.x, fromEnd.y, fromEnd.z});
        if (!isWhole) texels = std::min(texels, side + 0.5);
        volume.distances.push_back(static_cast<float>(std::round(texels * 64) / 64)); // halves hold it to the bit
        volume.nodes.push_back(std::abs(texels) < range ? node : 0);
      }
  return volume;
}

class WorldFieldReading : public GlTest {
protected:
  // Stores and binds the volumes as the passes do: a texel at its lattice place modulo the extent, nodes by tiles.
  void bind(const std::vector<FieldVolume>& volumes) {
    shared::FieldParams params{};
    std::vector<std::uint32_t> words;
    for (std::size_t c = 0; c < volumes.size(); ++c) {
      const FieldVolume& volume = volumes[c];
      shared::FieldCascade& row = params.cascades[c];
      row.window = glm::ivec4(volume.firstTexel, std::max({volume.extent.x, volume.extent.y, volume.extent.z}));
      row.texel = {volume.texelSize, 1 / volume.texelSize, volume.rangeTexels, 0.5};
      row.buffers = {words.size(), 0, 0, volume.isWhole ? shared::FIELD_WHOLE : 0u};
      row.extent = glm::vec4(volume.extent, 0);
      store(volume, words, static_cast<GLuint>(c));
    }
    params.counts.x = static_cast<std::uint32_t>(volumes.size());
    params_ = Buffer("field_params", std::vector<shared::FieldParams>{params});
    nodes_ = Buffer("field_nodes", words);
    params_.bindUniform(shared::kFieldUniformBinding);
    nodes_.bindStorage(shared::kFieldNodeBinding);
  }

  void store(const FieldVolume& volume, std::vector<std::uint32_t>& words, GLuint cascade) {
    const glm::ivec3 extent = volume.extent, tiles = extent / 8;
    std::vector<float> texels(volume.distances.size());
    const std::size_t firstWord = words.size();
    words.resize(firstWord + volume.nodes.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const auto index = static_cast<int>(i);
      const glm::ivec3 at(index % extent.x, index / extent.x % extent.y, index / (extent.x * extent.y));
      const glm::ivec3 slot = ((volume.firstTexel + at) % extent + extent) % extent, tile = slot / 8, in = slot % 8;
      texels[static_cast<std::size_t>((slot.z * extent.y + slot.y) * extent.x + slot.x)] = volume.distances[i];
      const int word = ((tile.z * tiles.y + tile.y) * tiles.x + tile.x) * 512 + (in.z * 8 + in.y) * 8 + in.x;
      words[firstWord + static_cast<std::size_t>(word)] = volume.nodes[i] | shared::FIELD_NODE_INSIDE;
    }
    Texture& texture = textures_.emplace_back(Texture::make3D("field", GL_R32F, extent));
    texture.upload(texels);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTextureParameteri(texture.id(), axis, GL_REPEAT);
    texture.bind(shared::kWorldFieldUnit + cascade);
  }

  struct Reading {
    float distanceWorld;
    int cascade;
    std::uint32_t node;
    glm::vec3 gradient;
  };
  std::vector<Reading> read(const std::vector<glm::vec3>& points) {
    std::vector<glm::vec4> inputs;
    for (const glm::vec3 point : points) inputs.emplace_back(point, 0);
    const auto program = bench_.load("#include \"lib/world_field_nodes.glsl\"\n", R"(
  FieldReading reading = readWorldField(inputs[index].xyz);
  outputs[2u * index] = vec4(fieldDistanceWorld(inputs[index].xyz), float(reading.cascade), 0.0, 0.0);
  uint node = fieldNode(inputs[index].xyz);
  outputs[2u * index].z = node == FIELD_NODE_UNCERTAIN ? -1.0 : float(node);
  outputs[2u * index + 1u] = vec4(fieldGradient(inputs[index].xyz), 0.0);)");
    std::vector<Reading> readings;
    const auto rows = ShaderBench::run(*program, inputs, points.size(), 2);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::vec4 row = rows[2 * i];
      readings.push_back({row.x, static_cast<int>(row.y),
                          row.z < 0 ? kFieldNodeUncertain : static_cast<std::uint32_t>(row.z),
                          glm::vec3(rows[2 * i + 1])});
    }
    return readings;
  }

  // The filter's weights may have eight bits, 1/512 of a texel off along each axis: of a field that changes by a texel
  // a texel that is 0.006. Where a point is so near to where one cascade takes over, the other may answer.
  void expectTwins(const std::vector<FieldVolume>& volumes, const std::vector<glm::vec3>& points, bool hasNodes) {
    bind(volumes);
    const std::vector<Reading> readings = read(points);
    std::size_t differing = 0, outside = 0, named = 0, uncertain = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const FieldSample sample = sampleField(volumes, points[i]);
      const double texel =
          (sample.cascade < 0 ? volumes.back() : volumes[static_cast<std::size_t>(sample.cascade)]).texelSize;
      const glm::dvec3 gradient = fieldGradient(volumes, points[i]);
      const std::uint32_t node = fieldNode(volumes, points[i]);
      outside += sample.cascade < 0;
      named += node != 0 && node != kFieldNodeUncertain;
      uncertain += node == kFieldNodeUncertain;
      const bool isSame = std::abs(readings[i].distanceWorld - sample.distanceWorld) < 0.01 * texel &&
                          readings[i].cascade == sample.cascade && (!hasNodes || readings[i].node == node) &&
                          glm::distance(glm::dvec3(readings[i].gradient), gradient) < 0.03;
      differing += !isSame;
    }
    EXPECT_LE(differing, points.size() / 200) << "of " << points.size();
    EXPECT_GT(outside, points.size() / 50);
    EXPECT_GT(named, points.size() / 20);
    EXPECT_GT(uncertain, 10u);
  }

  static std::vector<glm::vec3> pointsWithin(float reach, int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-reach, reach);
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) points.emplace_back(unit(random), unit(random), unit(random));
    return points;
  }

  ShaderBench bench_;
  Buffer params_, nodes_;
  std::vector<Texture> textures_;
};

std::vector<FieldVolume> threeCascades() {
  return {makeVolume({-8, -24, -16}, glm::ivec3(32), 0.05, 4, false),
          makeVolume({-24, -16, -8}, glm::ivec3(32), 0.1, 4, false),
          makeVolume({-16, -8, -24}, glm::ivec3(32), 0.2, 4, false)};
}

TEST_F(WorldFieldReading, CascadesAreReadAsByTheTwin) { expectTwins(threeCascades(), pointsWithin(4, 4000), true); }

// Nodes are in tiles of cubes, which such a volume has not.
TEST_F(WorldFieldReading, OneVolumeOfAnyShapeIsReadAsByTheTwin) {
  expectTwins({makeVolume({-40, -8, -16}, {64, 24, 40}, 0.06, 100, true)}, pointsWithin(2.5f, 4000), false);
}

// The twin itself against the balls: near surfaces as exact as interpolation allows, and never above the truth by more,
// inside the windows, beyond the range, at the borders and outside of all.
TEST_F(WorldFieldReading, TwinIsABoundEverywhereAndExactNearSurfaces) {
  const std::vector<FieldVolume> volumes = threeCascades();
  const Ball& inside = kBalls[2];
  std::size_t near = 0;
  std::vector<glm::vec3> points = pointsWithin(5, 10000);
  for (const glm::vec3 point : pointsWithin(1, 10000)) points.push_back(point);
  for (const glm::vec3 point : points) {
    double truth = 1e9;
    for (const Ball& ball : kBalls)
      truth = std::min(truth, glm::distance(glm::dvec3(point), ball.center) - ball.radius);
    const FieldSample sample = sampleField(volumes, point);
    // Interpolation over h of a curvature of 1/r is h^2/(2r) too long at most; the coarsest cascade's texels decide.
    if (truth > 0) {
      EXPECT_LE(sample.distanceWorld, truth + 0.2 * 0.2 / (2 * 0.2)) << point.x << " " << point.y;
    }
    const double toSmall = glm::distance(glm::dvec3(point), inside.center) - inside.radius;
    if (sample.cascade != 0 || std::abs(toSmall) > 0.05 || std::abs(truth - toSmall) > 1e-9) continue;
    ++near;
    EXPECT_NEAR(sample.distanceWorld, toSmall, 0.01);
    EXPECT_NEAR(glm::length(fieldGradient(volumes, point)), 1.0, 0.2)
        << "of a ball of four texels, whose cells meet in kinks";
  }
  EXPECT_GT(near, 50u);
}

// Past a cascade's range the next one says more; at its border too.
TEST_F(WorldFieldReading, CoarserCascadesAnswerWhereFinerOnesEnd) {
  const std::vector<FieldVolume> volumes = threeCascades();
  const glm::dvec3 far(0.1, -0.05, -0.45); // well inside the finest, farther from all balls than its 0.2 m
  const FieldSample sample = sampleField(volumes, far);
  ASSERT_EQ(sample.cascade, 0);
  EXPECT_GT(sample.distanceWorld, 0.25);
  EXPECT_NEAR(sampleField(std::span(volumes).first(1), far).distanceWorld, 0.2, 0.02);
}

} // namespace
} // namespace brickfield::test
