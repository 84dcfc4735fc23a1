// The line of a bar.
#include "app/progress_bar.h"

#include <gtest/gtest.h>

namespace brickfield {
namespace {

TEST(ProgressLine, FillsWithTheShare) {
  EXPECT_EQ(progressLine("bake", 0, 4, 8), "[--------]   0 %  bake");
  EXPECT_EQ(progressLine("bake", 2, 4, 8), "[####----]  50 %  bake");
  EXPECT_EQ(progressLine("bake", 4, 4, 8), "[########] 100 %  bake");
  EXPECT_EQ(progressLine("bake", 9, 4, 8), "[########] 100 %  bake");
  EXPECT_EQ(progressLine("bake", 0, 0, 8), "[########] 100 %  bake");
}

} // namespace
} // namespace brickfield
