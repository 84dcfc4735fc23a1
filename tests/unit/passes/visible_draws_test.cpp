// What a view leaves out is nothing that it could see: against rays through the boxes' corners and middles.
#include "passes/geometry/visible_draws.h"

#include <random>

#include <gtest/gtest.h>

#include "scene/shadow_views.h"

namespace brickfield {
namespace {

bool isSeen(glm::dvec3 pointWorld, const View& view) {
  const glm::dvec4 clip = clipFromEye(view) * glm::dvec4(pointWorld - glm::dvec3(view.eyeWorld), 1.0);
  return clip.w > 0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z <= clip.w;
}

// Boxes strewn around an anchor far from the origin; three batches of which the second is empty.
struct Strewn {
  glm::dvec3 anchor{5000, 20, -3000};
  std::vector<MeshBatch> batches{{{}, 0, 0, 150, false}, {{}, 0, 150, 0, false}, {{}, 0, 150, 50, false}};
  std::vector<Box> boxes;

  Strewn() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-6, 6), size(0.05f, 1);
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 low(place(random), place(random), place(random));
      boxes.push_back({low, low + glm::vec3(size(random), size(random), size(random))});
    }
    boxes[7] = Box(); // nothing of it is finite
  }

  std::vector<bool> drawn(const View& view) const {
    std::vector<bool> isDrawn(boxes.size(), false);
    std::uint32_t next = 0;
    for (const DrawRun& run : visibleDraws({batches, boxes, anchor}, view)) {
      const MeshBatch& batch = batches.at(run.batch);
      EXPECT_GE(run.firstDraw, next) << "in order";
      EXPECT_GE(run.firstDraw, batch.firstDraw);
      EXPECT_LE(run.firstDraw + run.drawCount, batch.firstDraw + batch.drawCount);
      for (next = run.firstDraw; next < run.firstDraw + run.drawCount; ++next) isDrawn[next] = true;
    }
    return isDrawn;
  }

  bool isAnySeen(std::size_t draw, const View& view) const {
    const Box& box = boxes[draw];
    constexpr int kSteps = 6;
    for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
      const glm::dvec3 share = glm::dvec3(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps) / (kSteps - 1.0);
      if (isSeen(anchor + glm::mix(glm::dvec3(box.min), glm::dvec3(box.max), share), view)) return true;
    }
    return false;
  }

  Box bounds() const {
    Box all;
    for (const Box& box : boxes) all.extend(box);
    return {all.min + glm::vec3(anchor), all.max + glm::vec3(anchor)};
  }
};

TEST(VisibleDraws, NothingThatAViewSeesIsLeftOut) {
  const Strewn strewn;
  const View camera = makePerspectiveView(glm::vec3(strewn.anchor) + glm::vec3(-3, 1, 5), glm::vec3(strewn.anchor),
                                          0.7f, 0.1f, {320, 180});
  PosedLight sun, point;
  sun.light.kind = LightKind::Sun;
  sun.directionWorld = glm::normalize(glm::vec3(0.4f, -1, -0.3f));
  point.light.kind = LightKind::Point;
  point.positionWorld = glm::vec3(strewn.anchor) + glm::vec3(1, 2, 0);
  std::size_t drawn = 0, seen = 0, all = 0;
  for (const PosedLight& light : {sun, point})
    for (const ShadowView& shadow : makeShadowViews(light, camera, strewn.bounds(), 512)) {
      const std::vector<bool> isDrawn = strewn.drawn(shadow.view);
      EXPECT_FALSE(isDrawn[7]);
      for (std::size_t i = 0; i < isDrawn.size(); ++i) {
        if (i == 7) continue;
        const bool isAny = strewn.isAnySeen(i, shadow.view);
        EXPECT_TRUE(isDrawn[i] || !isAny) << i;
        ++all, drawn += isDrawn[i], seen += isAny;
      }
    }
  EXPECT_GT(seen, all / 10);
  EXPECT_LT(drawn, all * 2 / 3) << "the rest is left out";
}

// A sun's own square holds what it holds however far up or down it is: nothing is behind a sun.
TEST(VisibleDraws, WholeScenesAreOneRunABatch) {
  const Strewn strewn;
  const Box bounds = strewn.bounds();
  const View view =
      makeParallelView(glm::dvec3(bounds.center()) + glm::dvec3(0, 20, 0), {0, -1, 0}, 20, 0, 40, {64, 64});
  const std::vector<DrawRun> runs = visibleDraws({strewn.batches, strewn.boxes, strewn.anchor}, view);
  ASSERT_EQ(runs.size(), 3u) << "the box of nothing parts the first batch";
  EXPECT_EQ(runs[0].drawCount + runs[1].drawCount + runs[2].drawCount, 199u);
  EXPECT_EQ(runs[2].batch, 2u);
}

// A room around the eye comes last; within a step the batches keep their order.
TEST(VisibleDraws, WhatHidesComesFirst) {
  const std::vector<MeshBatch> batches{
      {{}, 0, 0, 1, false}, {{}, 0, 1, 1, false}, {{}, 0, 2, 2, false}, {{}, 0, 4, 1, false}};
  const glm::dvec3 anchor(100, 0, 0);
  std::vector<Box> boxes{{{-9, -9, -10}, {9, 9, 9}}};
  for (const float z : {-2.1f, -2.0f, -1.9f, -0.9f}) boxes.push_back({{-0.1f, -0.1f, z}, {0.1f, 0.1f, z + 0.1f}});
  const View view = makePerspectiveView(anchor, glm::vec3(anchor) + glm::vec3(0, 0, -1), 0.7f, 0.1f, {320, 180});
  const MeshDraws draws{batches, boxes, anchor};
  const std::vector<DrawRun> runs = frontToBack(visibleDraws(draws, view), draws, view);
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_EQ(runs[0].batch, 3u);
  EXPECT_EQ(runs[1].batch, 1u);
  EXPECT_EQ(runs[2].batch, 2u);
  EXPECT_EQ(runs[2].drawCount, 2u);
  EXPECT_EQ(runs[3].batch, 0u);
}

} // namespace
} // namespace brickfield
