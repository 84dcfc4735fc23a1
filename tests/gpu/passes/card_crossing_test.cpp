// shaders/lib/card_crossing.glsl against its C++ twin, on a card in the real atlas.
#include <fmt/format.h>

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

} // namespace
} // namespace brickfield::test
