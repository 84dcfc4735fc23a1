// Windows and dirty tiles, against the definition: a texel's distance to a box by brute force.
#include "field/field_windows.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace brickfield::test {
namespace {

FieldWindow windowAt(glm::ivec3 firstTexel, int texels = 64) { return {firstTexel, texels, 0.5, false}; }

bool holds(const std::vector<std::uint32_t>& words, std::uint32_t word) {
  return std::binary_search(words.begin(), words.end(), word);
}

std::size_t tileCount(const FieldWindow& window) {
  return static_cast<std::size_t>(window.tiles() * window.tiles() * window.tiles());
}

template <typename Visit>
void forEachTile(const FieldWindow& window, Visit visit) {
  const glm::ivec3 first = window.firstTexel / kFieldTileTexels;
  for (int z = 0; z < window.tiles(); ++z)
    for (int y = 0; y < window.tiles(); ++y)
      for (int x = 0; x < window.tiles(); ++x) visit(first + glm::ivec3(x, y, z));
}

// Texels between the nearest parts of a tile and of a box of metres, along the axis where they are farthest apart.
double gapTexels(const FieldWindow& window, glm::ivec3 tile, const Box& box) {
  double gap = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = tile[axis] * kFieldTileTexels, high = low + kFieldTileTexels;
    gap = std::max({gap, box.min[axis] / window.texelSize - high, low - box.max[axis] / window.texelSize});
  }
  return gap;
}

TEST(FieldWindows, CascadesDoubleAndHoldTheEyeInTheirMiddle) {
  const Box bounds{glm::vec3(-10), glm::vec3(30, 5, 10)};
  const glm::dvec3 eye(3.7, -2.2, 1.9);
  const auto windows = fieldWindows({4, 128, 0, false}, bounds, eye);
  ASSERT_EQ(windows.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(windows[i].texelSize, 40.0 / ((128 - 12) * 8) * std::exp2(i)) << "the coarsest covers the scene";
    EXPECT_EQ(windows[i].firstTexel % kFieldTileTexels, glm::ivec3(0));
  }
  const glm::dvec3 eyeTexel = eye / windows[0].texelSize - glm::dvec3(windows[0].firstTexel);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(eyeTexel[axis], 64 - kFieldTileTexels / 2);
    EXPECT_LE(eyeTexel[axis], 64 + kFieldTileTexels / 2);
  }
}

// From wherever the eye looks, the coarsest window holds the scene and the finer ones stand in it, on the eye's side.
TEST(FieldWindows, CascadesStayInTheSceneWhenTheEyeDoesNot) {
  const Box bounds{glm::vec3(-10), glm::vec3(30, 5, 10)};
  for (const glm::dvec3 eye : {glm::dvec3(100, 3, 0), glm::dvec3(-1e6, 1e6, 50), glm::dvec3(9, -40, 11)})
    for (const int cascades : {1, 2, 4, 8}) {
      const auto windows = fieldWindows({cascades, 64, 0, false}, bounds, eye);
      const Box held = windows.back().boundsAnchored();
      const auto margin = static_cast<float>(1.5 * windows.back().texelSize);
      EXPECT_TRUE(held.contains(bounds.min - margin) && held.contains(bounds.max + margin)) << cascades;
      const double tile = windows[0].texelSize * kFieldTileTexels;
      const Box finest = windows[0].boundsAnchored();
      for (int axis = 0; axis < 3 && cascades == 8; ++axis) {
        const double nearest = std::clamp<double>(eye[axis], bounds.min[axis], bounds.max[axis]);
        EXPECT_LT(finest.min[axis] - tile, nearest) << axis;
        EXPECT_GT(finest.max[axis] + tile, nearest) << axis;
      }
    }
}

TEST(FieldWindows, OneWindowHoldsTheWholeSceneWithAMargin) {
  for (const glm::vec3 center : {glm::vec3(0), glm::vec3(3.3f, -7.1f, 100.0f)})
    for (const float size : {0.01f, 1.0f, 1e4f}) {
      const Box bounds{center - glm::vec3(0.5f, 0.1f, 0.3f) * size, center + glm::vec3(0.5f, 0.1f, 0.3f) * size};
      const auto windows = fieldWindows({1, 64, 0, true}, bounds, glm::dvec3(0));
      ASSERT_EQ(windows.size(), 1u);
      const Box held = windows[0].boundsAnchored();
      const auto margin = static_cast<float>(1.5 * windows[0].texelSize); // two, less the roundings
      EXPECT_TRUE(held.contains(bounds.min - margin) && held.contains(bounds.max + margin)) << size;
      EXPECT_LT(windows[0].texelSize, size / 64 * 1.25);
    }
  EXPECT_GT(fieldWindows({1, 64, 0, true}, Box{}, glm::dvec3(0))[0].texelSize, 0) << "an empty scene";
}

TEST(FieldUpdate, FirstPlanIsEverythingAndAStillSceneNothing) {
  FieldUpdatePlanner planner;
  const std::vector<FieldWindow> windows{windowAt({-32, -32, -32}), windowAt({-40, 0, 8})};
  const FieldUpdate first = planner.plan(windows, {}, {});
  EXPECT_EQ(first.keys.size(), 2 * tileCount(windows[0]));
  EXPECT_EQ(first.values.size(), 2 * tileCount(windows[0]));
  EXPECT_TRUE(std::is_sorted(first.values.begin(), first.values.end()));
  EXPECT_TRUE(planner.plan(windows, {}, {}).isEmpty());
  planner.reset();
  EXPECT_EQ(planner.plan(windows, {}, {}).values.size(), 2 * tileCount(windows[0]));
}

TEST(FieldUpdate, MovedMeshMarksWhatItReachesAndNotMuchMore) {
  const FieldWindow window = windowAt({-64, -64, -64}, 128);
  FieldUpdatePlanner planner;
  planner.plan({window}, {}, {});
  const Box moved{glm::vec3(3.1f, -2, 5), glm::vec3(5.2f, 0.4f, 6)};
  const FieldUpdate update = planner.plan({window}, {&moved, 1}, {});
  forEachTile(window, [&](glm::ivec3 tile) {
    const double gap = gapTexels(window, tile, moved);
    const std::uint32_t word = fieldTileWord(0, window, tile);
    if (gap < kFieldSplatTexels) {
      EXPECT_TRUE(holds(update.keys, word));
    }
    if (gap > kFieldSplatTexels + 3) {
      EXPECT_FALSE(holds(update.keys, word));
    }
    if (gap < window.rangeTexels() + 8) {
      EXPECT_TRUE(holds(update.candidates, word));
    }
    if (gap > window.rangeTexels() + 16) {
      EXPECT_FALSE(holds(update.candidates, word));
    }
    EXPECT_EQ(holds(update.candidates, word), holds(update.values, word));
    if (holds(update.candidates, word)) {
      const int reach = (2 * fieldSweepReach(window.rangeTexels()) + 7) / 8;
      for (const int step : {-reach, reach}) {
        const auto inside = [&](glm::ivec3 t) { return glm::all(glm::lessThan(glm::abs(t * 2 + 1), glm::ivec3(16))); };
        const glm::ivec3 z = tile + glm::ivec3(0, 0, step);
        if (inside(z)) {
          EXPECT_TRUE(holds(update.planes, fieldTileWord(0, window, z)));
        }
      }
    }
  });
}

TEST(FieldUpdate, MovedObjectChangesValuesAlone) {
  const FieldWindow window = windowAt({-64, -64, -64}, 128);
  FieldUpdatePlanner planner;
  planner.plan({window}, {}, {});
  const Box moved{glm::vec3(3.1f, -2, 5), glm::vec3(5.2f, 0.4f, 6)};
  const FieldUpdate update = planner.plan({window}, {}, {&moved, 1});
  EXPECT_TRUE(update.keys.empty() && update.planes.empty() && update.candidates.empty());
  forEachTile(window, [&](glm::ivec3 tile) {
    const double gap = gapTexels(window, tile, moved);
    const bool held = holds(update.values, fieldTileWord(0, window, tile));
    if (gap < window.rangeTexels()) {
      EXPECT_TRUE(held);
    }
    if (gap > window.rangeTexels() + 10) {
      EXPECT_FALSE(held);
    }
  });
}

TEST(FieldUpdate, ScrollMakesWhatEnteredAnew) {
  const FieldWindow before = windowAt({-64, -64, -64}, 128);
  for (const glm::ivec3 shift : {glm::ivec3(8, 0, 0), glm::ivec3(0, -16, 0), glm::ivec3(8, 8, -8), glm::ivec3(1024)}) {
    FieldWindow now = before;
    now.firstTexel += shift;
    FieldUpdatePlanner planner;
    planner.plan({before}, {}, {});
    const FieldUpdate update = planner.plan({now}, {}, {});
    std::size_t entered = 0;
    forEachTile(now, [&](glm::ivec3 tile) {
      const glm::ivec3 texel = tile * kFieldTileTexels;
      const bool wasHeld = glm::all(glm::greaterThanEqual(texel, before.firstTexel)) &&
                           glm::all(glm::lessThan(texel, before.firstTexel + before.texels));
      entered += !wasHeld;
      EXPECT_EQ(holds(update.keys, fieldTileWord(0, now, tile)), !wasHeld);
      // What ended at a border that has moved is made anew on both sides.
      for (int axis = 0; axis < 3; ++axis) {
        const int toLow = texel[axis] - now.firstTexel[axis], toHigh = now.texels - kFieldTileTexels - toLow;
        if (shift[axis] != 0 && std::min(toLow, toHigh) < now.rangeTexels()) {
          EXPECT_TRUE(holds(update.values, fieldTileWord(0, now, tile)));
        }
      }
    });
    EXPECT_EQ(update.keys.size(), entered);
  }
}

TEST(FieldUpdate, TileWordsNameEachSlotOnce) {
  const FieldWindow window = windowAt({-40, 8, 1048576}, 64);
  std::vector<std::uint32_t> words;
  forEachTile(window, [&](glm::ivec3 tile) {
    words.push_back(fieldTileWord(3, window, tile));
    EXPECT_EQ(fieldTileLattice(window, words.back() & 0xffffffu), tile);
  });
  std::sort(words.begin(), words.end());
  EXPECT_EQ(words.front(), 3u << 24);
  EXPECT_EQ(words.back(), (3u << 24) + 511u);
  EXPECT_EQ(std::unique(words.begin(), words.end()), words.end());
}

TEST(FieldUpdate, BoxesWithoutNumbersAreEverywhere) {
  const FieldWindow window = windowAt({-32, -32, -32});
  FieldUpdatePlanner planner;
  planner.plan({window}, {}, {});
  const Box infinite{glm::vec3(-INFINITY), glm::vec3(INFINITY)}, nothing;
  EXPECT_EQ(planner.plan({window}, {&infinite, 1}, {}).keys.size(), tileCount(window));
  EXPECT_TRUE(planner.plan({window}, {&nothing, 1}, {&nothing, 1}).isEmpty());
}

} // namespace
} // namespace brickfield::test
