// Shadows from the world field against closed forms: the share of a sun's disk that a straight edge leaves free.
#include <cstdio>

#include "tests/oracle/passes/edge_scene.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/tube_mesh.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{480, 360};

RendererSettings marching(int texels) {
  RendererSettings settings;
  settings.shadows.method = ShadowMethod::Field;
  settings.worldField.shape = {1, texels, 0, true};
  return settings;
}

class FieldShadow : public GlTest {
protected:
  FieldShadow() : scene_(slabOverFloor(), "none"), view_(viewOfEdge(scene_, kSize)) {}

  std::vector<FloorSample> draw(Renderer& renderer, double degrees) const {
    renderer.setLighting(overheadSun(scene_, degrees));
    renderer.render(view_);
    return floorSamples(view_, renderer.readLayers());
  }

  void expectPenumbrae(int texels, std::initializer_list<double> suns, double mostWidthError, double mostRmse) const;

  TestScene scene_;
  View view_;
};

void FieldShadow::expectPenumbrae(int texels, std::initializer_list<double> suns, double mostWidthError,
                                  double mostRmse) const {
  const auto renderer = scene_.makeRenderer(context().info(), marching(texels));
  for (const double degrees : suns) {
    const double spread = std::tan(0.5 * degrees * std::numbers::pi / 180);
    const std::vector<FloorSample> samples = draw(*renderer, degrees);
    ASSERT_GT(samples.size(), 5000u);
    const double texel = 2.4 / texels; // of a field that holds the floor, about
    double squares = 0;
    std::size_t count = 0;
    for (int step = 0; step < 10; ++step) {
      const double z = -0.4 + 0.155 * step;
      // Widths as the integral of 4 v (1 - v) over x, which is a multiple of the penumbra's.
      const auto truth = [&](double x) { return shareBelow(x / (spread * heightAt(z, x > 0))); };
      std::vector<FloorSample> row;
      for (const FloorSample& sample : samples)
        if (std::abs(sample.z - z) < 0.03 && std::abs(sample.x) < 0.4) row.push_back(sample);
      std::sort(row.begin(), row.end(), [](auto& a, auto& b) { return a.x < b.x; });
      ASSERT_GT(row.size(), 50u);
      double width = 0, expected = 0, offset = 0;
      for (std::size_t i = 1; i < row.size(); ++i) {
        const double dx = row[i].x - row[i - 1].x, v = 0.5 * (row[i].visible + row[i - 1].visible);
        const double t = 0.5 * (truth(row[i].x) + truth(row[i - 1].x));
        width += 4 * v * (1 - v) * dx;
        expected += 4 * t * (1 - t) * dx;
        offset += (t - v) * dx;
        squares += (v - t) * (v - t);
        ++count;
      }
      std::printf("%d texels, %g degrees, edge %.2f m above: width %.4f, expected %.4f, shifted by %.4f m\n", texels,
                  degrees, heightAt(z, false), width, expected, offset);
      EXPECT_NEAR(width, expected, mostWidthError * expected) << z;
      // Half a texel, and a part of the fade.
      EXPECT_LE(std::abs(offset), 0.5 * texel + 0.05 * spread * heightAt(z, true)) << z;
    }
    const double rmse = std::sqrt(squares / static_cast<double>(count));
    std::printf("%d texels, %g degrees: rmse %.4f\n", texels, degrees, rmse);
    EXPECT_LE(rmse, mostRmse);
  }
}

// Eight degrees spread over three to seven texels of the coarser field, where a texel is a quarter of a width.
TEST_F(FieldShadow, PenumbraeUnderAnEdgeHaveTheirWidth) { expectPenumbrae(128, {8.0, 16.0}, 0.1, 0.016); }
// Of size M.
TEST_F(FieldShadow, PenumbraeOfAFinerFieldAreTrueToATenth) { expectPenumbrae(256, {8.0}, 0.1, 0.012); }

// Four rays that no pixels share are off by 0.08, by their steps.
TEST_F(FieldShadow, NeighboursHideTheStepsOfFewRays) {
  RendererSettings settings = marching(128);
  settings.shadows.penumbraRays = 4;
  const auto renderer = scene_.makeRenderer(context().info(), settings);
  constexpr double kDegrees = 30;
  const double spread = std::tan(0.5 * kDegrees * std::numbers::pi / 180);
  double squares = 0;
  std::size_t count = 0;
  for (const FloorSample& sample : draw(*renderer, kDegrees)) {
    if (std::abs(sample.x) > 0.35 || std::abs(sample.z) > 0.6) continue;
    const double truth = shareBelow(sample.x / (spread * heightAt(sample.z, sample.x > 0)));
    squares += (sample.visible - truth) * (sample.visible - truth), ++count;
  }
  ASSERT_GT(count, 3000u);
  const double rmse = std::sqrt(squares / static_cast<double>(count));
  std::printf("four rays, 30 degrees: rmse %.4f\n", rmse);
  EXPECT_LE(rmse, 0.05);
}

// Nothing is above the floor in front of the slab, and nothing shines through the slab: no acne, no leak.
TEST_F(FieldShadow, LitFloorsAreLitAndUmbraeAreDark) {
  const auto renderer = scene_.makeRenderer(context().info(), marching(128));
  std::size_t free = 0, speckled = 0, covered = 0, leaking = 0;
  for (const FloorSample& sample : draw(*renderer, 0.5)) {
    if (sample.x > 0.06 && sample.x < 1.1) ++free, speckled += sample.visible < 0.98;
    if (sample.x < -0.06 && sample.x > -1.1) ++covered, leaking += sample.visible > 0.02;
  }
  ASSERT_GT(free, 3000u);
  ASSERT_GT(covered, 1000u);
  EXPECT_EQ(speckled, 0u);
  EXPECT_EQ(leaking, 0u);
}

// Rays begin a texel of the field above the floor: higher than an object's plate that hides the sun there.
TEST_F(FieldShadow, PlatesLowerThanWhereRaysBeginHideTheSun) {
  for (const float bottom : {0.008f, 0.011f, 0.014f}) {
    constexpr float kPlateHalf = 0.0025f;
    Scene built = slabOverFloor();
    built.nodes[1].name = "Plate";
    built.nodes[1].matrix = glm::translate(glm::mat4(1), {0, bottom + kPlateHalf, 0});
    built.meshes[1] = makeBoxMesh({0.3f, kPlateHalf, 0.3f});
    const TestScene scene(std::move(built), "Plate", 256);
    const auto renderer = scene.makeRenderer(context().info(), marching(128));
    renderer->setLighting(overheadSun(scene, 0.5));
    const float eye = 0.6f * bottom;
    const View view = scene.view({1, eye, 0}, {0, eye, 0}, kSize, 5);
    renderer->render(view);
    std::size_t covered = 0, leaking = 0, free = 0, dark = 0;
    for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) {
      const double away = std::max(std::abs(sample.x), std::abs(sample.z));
      if (away < 0.28) ++covered, leaking += sample.visible > 0.02;
      if (away > 0.35) ++free, dark += sample.visible < 0.98;
    }
    ASSERT_GT(covered, 300u);
    ASSERT_GT(free, 1000u);
    EXPECT_EQ(leaking, 0u) << "of " << covered << ", plate " << bottom << " m above";
    EXPECT_LE(dark, free / 1000) << "of " << free;
  }
}

// A sun as low as 20 degrees behind a wall on the border of the field: the axis leaves the field just behind the wall,
// before the slower rays of the disk have come to it.
TEST_F(FieldShadow, WallsOnTheBorderHideAllOfAWideSun) {
  Scene built = slabOverFloor();
  built.nodes[1].matrix = glm::translate(glm::mat4(1), {-1.19f, 0.6f, 0});
  built.meshes[1] = makeBoxMesh({0.01f, 0.6f, 1.2f});
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), marching(128));
  renderer->setLighting(makeLighting(scene.pose(), {"sun:0.94,-0.342,0:16:3"}, {{1, 1}, {glm::vec3(0)}}));
  const View view = viewOfEdge(scene, kSize);
  renderer->render(view);
  std::size_t covered = 0, leaking = 0;
  for (const FloorSample& sample : floorSamples(view, renderer->readLayers()))
    if (std::abs(sample.x) < 0.8 && std::abs(sample.z) < 0.6) ++covered, leaking += sample.visible > 0.02;
  ASSERT_GT(covered, 3000u);
  EXPECT_EQ(leaking, 0u) << "of " << covered;
}

// At the foot of a wall that is a single sheet, half a texel of the floor to each side lies in what the field adds to
// it: the side that faces the sun is lit all the same, and the other dark.
TEST_F(FieldShadow, FeetOfSheetsAreLitFromTheirOwnSide) {
  Scene built = slabOverFloor();
  Mesh wall;
  wall.primitives.emplace_back();
  wall.primitives[0].positions = {{0.003f, 0, -1}, {0.003f, 0, 1}, {0.003f, 0.5f, 1}, {0.003f, 0.5f, -1}};
  wall.primitives[0].normals.assign(4, {1, 0, 0});
  wall.primitives[0].indices = {0, 1, 2, 0, 2, 3};
  built.nodes[1].matrix = glm::mat4(1);
  built.meshes[1] = std::move(wall);
  for (const bool hasBricks : {false, true}) {
    const TestScene scene(built, hasBricks ? "*" : "none", 256);
    const auto renderer = scene.makeRenderer(context().info(), marching(128));
    renderer->setLighting(makeLighting(scene.pose(), {"sun:-1,-1,0:0.5:3"}, {{1, 1}, {glm::vec3(0)}}));
    const double grain = 2.4 / (hasBricks ? 256 : 128);
    std::size_t lit = 0, dark = 0, covered = 0, leaking = 0;
    for (const float eye : {0.3f, -0.3f}) {
      const View view = scene.view({eye, 0.3f, 0}, {0.003f, 0, 0}, kSize, 20);
      renderer->render(view);
      for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) {
        const double way = (sample.x - 0.003) / grain;
        if (way > 0.1 && way < 0.9) ++lit, dark += sample.visible < 0.98;
        if (way < -0.1 && way > -0.9) ++covered, leaking += sample.visible > 0.02;
      }
    }
    ASSERT_GT(lit, 1000u);
    ASSERT_GT(covered, 1000u);
    std::printf("feet of a sheet%s: %zu of %zu dark, %zu of %zu leaking\n", hasBricks ? " of bricks" : "", dark, lit,
                leaking, covered);
    EXPECT_LE(dark, hasBricks ? lit / 6 : lit / 100) << "bricks: what lies in the slab";
    EXPECT_LE(leaking, covered / 100) << hasBricks;
  }
}

// Around the place where a ball stands on the floor interpolation fills the gap between them: the floor there is lit as
// far as the ball lets the sun pass, and no farther.
TEST_F(FieldShadow, GapsUnderBallsAreLitAsFarAsTheSunReaches) {
  constexpr double kRadius = 0.2;
  Scene built = slabOverFloor();
  built.nodes[1].matrix = glm::translate(glm::mat4(1), {0.003f, kRadius, 0.007f});
  built.meshes[1] = makeSphereMesh(kRadius, 192, 384);
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), marching(128));
  for (const double degrees : {20.0, 35.0, 50.0}) {
    const glm::dvec3 toSun(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)), 0);
    renderer->setLighting(
        makeLighting(scene.pose(), {"sun:" + std::to_string(-toSun.x) + "," + std::to_string(-toSun.y) + ",0:0.5:3"},
                     {{1, 1}, {glm::vec3(0)}}));
    const View view = scene.view({0.6f, 0.12f, 0}, {0.05f, 0, 0}, kSize, 35);
    renderer->render(view);
    std::size_t free = 0, dark = 0, covered = 0, leaking = 0;
    for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) {
      const glm::dvec3 toBall(0.003 - sample.x, kRadius, 0.007 - sample.z);
      const double ahead = glm::dot(toBall, toSun), past = std::sqrt(glm::dot(toBall, toBall) - ahead * ahead);
      if (std::hypot(toBall.x, toBall.z) > 0.15) continue;
      if (ahead < 0 || past > 1.02 * kRadius) ++free, dark += sample.visible < 0.9;
      if (ahead > 0 && past < 0.98 * kRadius) ++covered, leaking += sample.visible > 0.1;
    }
    std::printf("under a ball, sun at %g degrees: %zu of %zu dark, %zu of %zu leaking\n", degrees, dark, free, leaking,
                covered);
    ASSERT_GT(free, 200u) << degrees;
    ASSERT_GT(covered, 200u) << degrees;
    EXPECT_LE(dark, degrees < 30 ? free / 9 : free / 50) << degrees;
    EXPECT_LE(leaking, covered / 50) << degrees;
  }
}

// The same where the sun shines nearly along the sheet, wherever this lies between texels, and turned.
TEST_F(FieldShadow, FeetOfSheetsAreLitBySunsNearlyInTheirPlane) {
  for (const double turn : {0.0, 30.0}) {
    std::size_t lit = 0, dark = 0, covered = 0, leaking = 0;
    const glm::vec3 normal(std::cos(glm::radians(turn)), 0, std::sin(glm::radians(turn))),
        along(-normal.z, 0, normal.x);
    for (const float offset : {0.003f, 0.008f, 0.013f, 0.018f}) {
      Scene built = slabOverFloor();
      Mesh wall;
      wall.primitives.emplace_back();
      for (const glm::vec2 corner : {glm::vec2(-1, 0), {1, 0}, {1, 0.5f}, {-1, 0.5f}})
        wall.primitives[0].positions.push_back(offset * normal + corner.x * along + glm::vec3(0, corner.y, 0));
      wall.primitives[0].normals.assign(4, normal);
      wall.primitives[0].indices = {0, 1, 2, 0, 2, 3};
      built.nodes[1].matrix = glm::mat4(1);
      built.meshes[1] = std::move(wall);
      const TestScene scene(std::move(built), "none");
      const auto renderer = scene.makeRenderer(context().info(), marching(128));
      const glm::vec3 travels = -0.15f * normal;
      const std::string sun = "sun:" + std::to_string(travels.x) + ",-1," + std::to_string(travels.z) + ":0.5:3";
      renderer->setLighting(makeLighting(scene.pose(), {sun}, {{1, 1}, {glm::vec3(0)}}));
      const double texel = 2.4 / 128;
      for (const float eye : {0.3f, -0.3f}) {
        const View view = scene.view(eye * normal + glm::vec3(0, 0.3f, 0), {0.003f, 0, 0}, {240, 180}, 20);
        renderer->render(view);
        for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) {
          const double way = (normal.x * sample.x + normal.z * sample.z - offset) / texel;
          if (way > 0.1 && way < 0.9) ++lit, dark += sample.visible < 0.98;
          if (way < -0.1 && way > -1.7) ++covered, leaking += sample.visible > 0.02;
        }
      }
    }
    ASSERT_GT(lit, 1000u);
    ASSERT_GT(covered, 1000u);
    std::printf("feet of sheets, sun nearly in their plane, turned by %g: %zu of %zu dark, %zu of %zu leaking\n", turn,
                dark, lit, leaking, covered);
    EXPECT_LE(dark, lit / 10) << turn;
    EXPECT_LE(leaking, covered / 1000) << turn;
  }
}

// A tube is no thicker in the field than it is though its ends are open: its sides are no sheets.
TEST_F(FieldShadow, TubesOpenAtTheirEndsCastShadowsAsWideAsTheyAre) {
  constexpr float kRadius = 2 * 2.4f / 128;
  Scene built = slabOverFloor();
  built.nodes[1].matrix = glm::translate(glm::mat4(1), {0.003f, 0.4f, 0});
  built.meshes[1] = makeTubeMesh(kRadius, 1.1f, 32);
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), marching(128));
  renderer->setLighting(overheadSun(scene, 0.5));
  const View view = scene.view({0.8f, 0.3f, 0}, {0, 0, 0}, kSize, 40);
  renderer->render(view);
  std::vector<FloorSample> row;
  for (const FloorSample& sample : floorSamples(view, renderer->readLayers()))
    if (std::abs(sample.z) < 0.01 && std::abs(sample.x) < 0.2) row.push_back(sample);
  std::sort(row.begin(), row.end(), [](auto& a, auto& b) { return a.x < b.x; });
  ASSERT_GT(row.size(), 500u);
  double width = 0;
  for (std::size_t i = 1; i < row.size(); ++i)
    width += (1 - 0.5 * (row[i].visible + row[i - 1].visible)) * (row[i].x - row[i - 1].x);
  std::printf("shadow of a tube: %.4f m, as thick as %.4f m\n", width, 2 * static_cast<double>(kRadius));
  EXPECT_NEAR(width, 2 * kRadius, 0.2 * 2.4 / 128); // of a texel; a sheet's would be wider by 0.75 of one
}

// The same where two sheets meet on the floor: in their corner the field rises along no short way.
TEST_F(FieldShadow, CornersOfSheetsAreLitFromTheirOwnSide) {
  std::size_t lit = 0, dark = 0;
  for (const float offset : {0.003f, 0.008f, 0.013f, 0.018f}) {
    Scene built = slabOverFloor();
    Mesh walls;
    walls.primitives.emplace_back();
    walls.primitives[0].positions = {{offset, 0, -1}, {offset, 0, 1}, {offset, 0.5f, 1}, {offset, 0.5f, -1},
                                     {-1, 0, offset}, {1, 0, offset}, {1, 0.5f, offset}, {-1, 0.5f, offset}};
    walls.primitives[0].normals = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0},
                                   {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    walls.primitives[0].indices = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    built.nodes[1].matrix = glm::mat4(1);
    built.meshes[1] = std::move(walls);
    const TestScene scene(std::move(built), "none");
    const auto renderer = scene.makeRenderer(context().info(), marching(128));
    renderer->setLighting(makeLighting(scene.pose(), {"sun:-1,-1,-1:0.5:3"}, {{1, 1}, {glm::vec3(0)}}));
    const View view = scene.view({0.25f, 0.3f, 0.25f}, {0.003f, 0, 0.003f}, kSize, 12);
    renderer->render(view);
    const double texel = 2.4 / 128;
    for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) {
      const double x = (sample.x - offset) / texel, z = (sample.z - offset) / texel;
      if (std::min(x, z) > 0.1 && std::max(x, z) < 2) ++lit, dark += sample.visible < 0.98;
    }
  }
  ASSERT_GT(lit, 1000u);
  std::printf("corners of sheets: %zu of %zu dark\n", dark, lit);
  EXPECT_LE(dark, lit / 100);
}

// Bars as wide as their gaps, five texels each, under a sun that blurs them to one grey.
TEST_F(FieldShadow, GapsNarrowerThanPenumbraeLetTheirShareThrough) {
  Scene built = slabOverFloor();
  constexpr float kHalf = 2.5f * 2.4f / 128;
  Mesh bars;
  for (int bar = -6; bar <= 6; ++bar) {
    Mesh one = makeBoxMesh({kHalf, kHalf, 1.0f});
    for (glm::vec3& position : one.primitives[0].positions) position += glm::vec3(4 * kHalf * bar, 0.9f, 0);
    bars.primitives.push_back(std::move(one.primitives[0]));
  }
  built.nodes[1].matrix = glm::mat4(1);
  built.meshes[1] = std::move(bars);
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), marching(128));
  renderer->setLighting(overheadSun(scene, 20));
  const View view = viewOfEdge(scene, kSize);
  renderer->render(view);
  double sum = 0;
  std::size_t count = 0;
  for (const FloorSample& sample : floorSamples(view, renderer->readLayers()))
    if (std::abs(sample.x) < 0.6 && std::abs(sample.z) < 0.6) sum += sample.visible, ++count;
  ASSERT_GT(count, 3000u);
  std::printf("bars and gaps: %.3f of the light\n", sum / static_cast<double>(count));
  // Half, less what bars as tall as wide hide where the sun looks past their sides: 4 / (3 pi) of its radius on
  // average.
  const double slant = 4 / (3 * std::numbers::pi) * std::tan(10 * std::numbers::pi / 180);
  EXPECT_NEAR(sum / static_cast<double>(count), 0.5 - 0.5 * slant, 0.03);
}

// In the field a thin plate is a texel thick, which reaches beyond the box of its bricks: there too these decide, also
// beside something without bricks that is no nearer.
TEST_F(FieldShadow, ThinPlatesWithBricksCastNoWiderShadows) {
  constexpr float kHalf = 0.006f;
  for (const bool hasNeighbour : {false, true}) {
    Scene built = slabOverFloor();
    built.nodes[1].name = "Plate";
    built.nodes[1].matrix = glm::translate(glm::mat4(1), {0, 0.5f, 0});
    built.meshes[1] = makeBoxMesh({kHalf, 0.15f, 0.3f});
    if (hasNeighbour) {
      built.nodes.push_back({});
      built.nodes[2].mesh = 2;
      built.nodes[2].matrix = glm::translate(glm::mat4(1), {-kHalf - 0.05f, 0.5f, 0});
      built.meshes.push_back(makeBoxMesh({0.05f, 0.15f, 0.3f}));
      built.scenes[0].nodes.push_back(2);
    }
    const TestScene scene(std::move(built), "Plate", 256);
    const auto renderer = scene.makeRenderer(context().info(), marching(64)); // texels of 0.0375 m
    renderer->setLighting(overheadSun(scene, 0.5));
    const View view = scene.view({0.5f, 0.3f, 0}, {0, 0, 0}, kSize, 12);
    renderer->render(view);
    double width = 0;
    std::size_t all = 0, dark = 0;
    for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) {
      if (std::abs(sample.z) > 0.05 || sample.x < 0) continue;
      ++all;
      width += 1 - sample.visible;
      dark += sample.x > kHalf + 0.006 && sample.visible < 0.98;
    }
    ASSERT_GT(all, 10000u);
    EXPECT_GT(width, 0.0);
    EXPECT_LE(dark, all / 1000) << (hasNeighbour ? "beside a block" : "alone");
  }
}

// Light that grazes an object's plate begins at its voxels. Behind the plate's upper half stands a block without
// bricks: there the field alone answers, in which the plate is thicker than the way is high.
TEST_F(FieldShadow, GrazingLightPassesWhereBricksEnd) {
  Scene built = slabOverFloor();
  built.nodes[1].name = "Plate";
  built.nodes[1].matrix = glm::translate(glm::mat4(1), {0, 0.5f, 0});
  built.meshes[1] = makeBoxMesh({0.4f, 0.4f, 0.005f});
  built.nodes.push_back({});
  built.nodes[2].mesh = 2;
  built.nodes[2].matrix = glm::translate(glm::mat4(1), {0, 0.65f, -0.06f});
  built.meshes.push_back(makeBoxMesh({0.4f, 0.15f, 0.05f}));
  built.scenes[0].nodes.push_back(2);
  const TestScene scene(std::move(built), "Plate", 256);
  const auto renderer = scene.makeRenderer(context().info(), marching(64));
  const View view = scene.view({0, 0.5f, 1.2f}, {0, 0.5f, 0}, kSize, 40);
  for (const char* sun : {"sun:0,-1,-0.13:0.5:3", "sun:0,-1,-0.2:0.5:3", "sun:0.3,-1,-0.13:2:3"}) {
    renderer->setLighting(makeLighting(scene.pose(), {sun}, {{1, 1}, {glm::vec3(0)}}));
    renderer->render(view);
    const FrameLayers frame = renderer->readLayers();
    std::size_t lit = 0, dark = 0;
    for (std::size_t i = 0; i < frame.id.size(); ++i)
      if (frame.kind[i] == SurfaceKind::Sdf && frame.normalSurface[i].z > 0.99f)
        ++lit, dark += frame.shadow.front()[i] < 0.98f;
    ASSERT_GT(lit, 3000u);
    std::printf("%s: %zu of %zu dark\n", sun, dark, lit);
    EXPECT_EQ(dark, 0u) << sun;
  }
}

// On an object's plate a ridge lower than a voxel: light that grazes the plate does not pass over it. Its shadow is as
// long as the ridge is high over the tangent of the sun's height.
TEST_F(FieldShadow, RidgesLowerThanAVoxelShadeWhereLightGrazes) {
  constexpr float kVoxel = 0.8f / 256, kHigh = 0.75f * kVoxel, kHalf = 0.02f, kHeightDegrees = 8;
  Scene built = slabOverFloor();
  built.nodes[1].name = "Plate";
  built.nodes[1].matrix = glm::translate(glm::mat4(1), {0, 0.5f, 0});
  built.meshes[1] = makeBoxMesh({0.4f, 0.1f, 0.1f});
  built.nodes.push_back({});
  built.nodes[2].name = "PlateRidge";
  built.nodes[2].mesh = 2;
  built.nodes[2].matrix = glm::translate(glm::mat4(1), {0, 0.6f + kHigh - 0.05f, 0});
  built.meshes.push_back(makeBoxMesh({kHalf, 0.05f, 0.09f}));
  built.scenes[0].nodes.push_back(2);
  const TestScene scene(std::move(built), "Plate*", 256);
  const auto renderer = scene.makeRenderer(context().info(), marching(128));
  const float rises = std::tan(glm::radians(kHeightDegrees));
  renderer->setLighting(
      makeLighting(scene.pose(), {"sun:1," + std::to_string(-rises) + ",0:0.5:3"}, {{1, 1}, {glm::vec3(0)}}));
  const View view = scene.view({0.03f, 0.75f, 0}, {0.03f, 0.6f, 0.001f}, kSize, 30);
  renderer->render(view);
  const FrameLayers frame = renderer->readLayers();
  std::size_t covered = 0, leaking = 0, free = 0, dark = 0;
  for (std::size_t i = 0; i < frame.id.size(); ++i) {
    const glm::vec2 pixel(i % kSize.x, i / kSize.x);
    const PrimaryRay ray = primaryRay(view, pixel + 0.5f);
    const glm::vec3 point = ray.originWorld + frame.depth[i] * ray.directionWorld;
    if (frame.kind[i] != SurfaceKind::Sdf || frame.normalSurface[i].y < 0.99f) continue;
    const float way = (point.x - kHalf) / (kHigh / rises), visible = frame.shadow.front()[i];
    if (way > 0.2f && way < 0.6f) ++covered, leaking += visible > 0.1f;
    if (way > 1.6f) ++free, dark += visible < 0.9f;
  }
  ASSERT_GT(covered, 1000u);
  ASSERT_GT(free, 1000u);
  std::printf("behind a low ridge: %zu of %zu leaking, %zu of %zu dark\n", leaking, covered, dark, free);
  EXPECT_LE(leaking, covered / 50);
  EXPECT_LE(dark, free / 50);
}

// All of a sun of four degrees stands over the horizon of an open floor, its lowest rays by a fifth of a degree: these
// creep along the floor until their reads are spent, and have met nothing.
TEST_F(FieldShadow, RaysThatCreepAlongAnOpenFloorAreFree) {
  Scene built = slabOverFloor();
  built.scenes[0].nodes.pop_back();
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), marching(256));
  const float rises = std::tan(glm::radians(2.2f));
  renderer->setLighting(
      makeLighting(scene.pose(), {"sun:1," + std::to_string(-rises) + ",0:4:3"}, {{1, 1}, {glm::vec3(0)}}));
  const View view = scene.view({0.4f, 0.8f, 0}, {0.4f, 0, 0.001f}, kSize, 50);
  renderer->render(view);
  double sum = 0;
  std::size_t count = 0;
  for (const FloorSample& sample : floorSamples(view, renderer->readLayers())) sum += sample.visible, ++count;
  ASSERT_GT(count, 10000u);
  std::printf("open floor: %.3f of the light\n", sum / static_cast<double>(count));
  EXPECT_GT(sum / static_cast<double>(count), 0.97);
}

TEST_F(FieldShadow, TwoRunsAreTheSameBytes) {
  std::vector<std::vector<float>> shadows;
  for (int run = 0; run < 2; ++run) {
    const auto renderer = scene_.makeRenderer(context().info(), marching(64));
    renderer->setLighting(overheadSun(scene_, 8));
    renderer->render(view_);
    shadows.push_back(renderer->readLayers().shadow.front());
  }
  EXPECT_EQ(shadows[0], shadows[1]);
}

// What lies between the pixels that were marched is interpolated where they differ by less than a quarter: along a
// straight ramp exactly; a penumbra bends by 8 v'' of a pixel squared, here less than a twentieth.
TEST_F(FieldShadow, HalfResolutionIsNearTheFullOne) {
  RendererSettings settings = marching(128);
  const auto renderer = scene_.makeRenderer(context().info(), settings);
  const std::vector<FloorSample> full = draw(*renderer, 16);
  settings.shadows.halfResolution = true;
  settings.countersOn = true;
  renderer->setSettings(settings);
  const std::vector<FloorSample> half = draw(*renderer, 16);
  const std::uint32_t halfReads = renderer->stats().counters.shadowReads;
  settings.shadows.halfResolution = false;
  renderer->setSettings(settings);
  draw(*renderer, 16);
  EXPECT_LT(halfReads, renderer->stats().counters.shadowReads / 2);
  ASSERT_EQ(full.size(), half.size());
  double squares = 0, most = 0;
  for (std::size_t i = 0; i < full.size(); ++i) {
    const double difference = std::abs(full[i].visible - half[i].visible);
    squares += difference * difference;
    most = std::max(most, difference);
  }
  const double rmse = std::sqrt(squares / static_cast<double>(full.size()));
  std::printf("half against full: rmse %.4f, most %.3f\n", rmse, most);
  EXPECT_LE(rmse, 0.01);
  EXPECT_LE(most, 0.25);
}

// What a pixel is said to have read adds up to the frame's count.
TEST_F(FieldShadow, ReadsOfThePixelsAddUp) {
  for (const bool half : {false, true}) {
    RendererSettings settings = marching(64);
    settings.shadows.halfResolution = half;
    settings.countersOn = true;
    const auto renderer = scene_.makeRenderer(context().info(), settings);
    draw(*renderer, 8);
    std::uint64_t sum = 0;
    for (const std::uint32_t reads : renderer->readShadowReads()) sum += reads;
    EXPECT_GT(sum, 0u);
    EXPECT_EQ(sum, renderer->stats().counters.shadowReads);
  }
}

} // namespace
} // namespace brickfield::test
