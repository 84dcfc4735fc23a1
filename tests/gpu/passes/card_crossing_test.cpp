// shaders/lib/card_crossing.glsl against its C++ twin, on a card in the real atlas.
#include <array>

#include <fmt/format.h>

#include "field/analytic.h"
#include "field/card_crossing.h"
#include "field/surface_attributes.h"
#include "resident/brick_atlas.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/support/card_slab.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class CardCrossing : public GlTest {};

TEST_F(CardCrossing, IsThatOfTheTwin) {
  ShaderBench bench;
  const auto program = bench.load("#include \"lib/card_crossing.glsl\"\nuniform uint levelRow;", R"(
  SdfLevel level = sdfLevels[levelRow];
  vec4 met = inputs[index * 2u], direction = inputs[index * 2u + 1u];
  BrickAttributes attributes;
  readAttributes(level, met.xyz, attributes);
  outputs[index] = vec4(isCovered(level, met.xyz, direction.xyz, met.w != 0.0, attributes));)");
  Random random(4);
  std::size_t count = 0, different = 0, covered = 0;
  for (int c = 0; c < 8; ++c) {
    const CardSlab card = makeCardSlab(random, c % 2 == 1);
    BrickAtlas atlas;
    const std::uint32_t row = atlas.field(atlas.add(card.field)).firstLevel;
    atlas.bind();
    program->set("levelRow", row);
    const std::vector<CardRay> rays = cardRays(card, 500, random);
    std::vector<glm::vec4> inputs;
    for (const CardRay& ray : rays) {
      inputs.emplace_back((ray.met - card.field.originObject) / card.voxel(), ray.isBack ? 1 : 0);
      inputs.emplace_back(ray.direction, 0);
    }
    const std::vector<glm::vec4> outputs = ShaderBench::run(*program, inputs, rays.size(), 1);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool twin = isCovered(card.field, 0, rays[i].met, rays[i].direction, rays[i].isBack);
      ++count, covered += twin, different += twin != (outputs[i].x != 0);
      if (rays[i].isSure) {
        ASSERT_EQ(outputs[i].x != 0, rays[i].isCrossing) << c << " ray " << i;
      }
    }
  }
  fmt::print("{} rays, {} see the card, {} differ\n", count, covered, different);
  EXPECT_GT(covered, count / 5);
  EXPECT_LT(covered, count * 4 / 5);
  EXPECT_LE(different, count / 100); // at the border itself, filtered in other orders and steps
}

// An unlit card's byte lies next to that of a lit one, and far from that of what is unlit and no card: filtered
// together they would move the border between lit and unlit by half a voxel.
TEST_F(CardCrossing, UnlitEndsWhereTheTwinSaysThatItDoes) {
  ShaderBench bench;
  const auto program = bench.load("#include \"lib/brick_attributes.glsl\"\nuniform uint levelRow;", R"(
  SdfLevel level = sdfLevels[levelRow];
  BrickAttributes attributes;
  readAttributes(level, inputs[index].xyz, attributes);
  outputs[index] = vec4(isUnlit(level, inputs[index].xyz, attributes));)");
  const glm::vec3 half(1, 1, 0.2f);
  BrickField field =
      makeAnalyticField([&](glm::vec3 p) { return boxDistance(p, glm::vec3(0), half); }, {-half, half}, 32, 8, 1);
  Random random(7);
  addAttributes(field, [](glm::vec3) { return SurfaceAttributes{}; });
  // Lit and no card, a lit card, an unlit card, unlit and no card, by turns of a sample.
  for (std::uint32_t& row : field.levels[0].material) {
    const int axis = static_cast<int>(random.between(0, kCardAxes - 0.5f));
    const std::array<std::uint32_t, 4> bytes{0, cardByte(axis, false), cardByte(axis, true), 255};
    row = (row & 0xffffffu) | bytes[static_cast<std::size_t>(random.between(0, 3.99f))] << 24;
  }
  BrickAtlas atlas;
  const std::uint32_t row = atlas.field(atlas.add(field)).firstLevel;
  atlas.bind();
  program->set("levelRow", row);
  std::vector<glm::vec3> points;
  std::vector<glm::vec4> inputs;
  while (points.size() < 2000) {
    const glm::vec3 point = half * glm::vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    if (!attributesAt(field, 0, point)) continue;
    points.push_back(point);
    inputs.emplace_back((point - field.originObject) / field.levels[0].voxelSizeObject, 0);
  }
  const std::vector<glm::vec4> outputs = ShaderBench::run(*program, inputs, points.size(), 1);
  std::size_t unlit = 0, different = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool twin = attributesAt(field, 0, points[i])->unlit;
    unlit += twin, different += twin != (outputs[i].x != 0);
  }
  fmt::print("{} points, {} unlit, {} differ\n", points.size(), unlit, different);
  EXPECT_GT(unlit, points.size() / 3);
  EXPECT_LE(different, points.size() / 500); // weights round apart where they add up to one half
}

} // namespace
} // namespace brickfield::test
