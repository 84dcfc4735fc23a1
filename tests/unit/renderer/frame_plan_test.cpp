// The plan's checks and barriers, without any GL call.
#include "renderer/frame_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/gl.h"
#include "renderer/renderer.h"

namespace brickfield::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<PlannedPass> passesOf(const std::vector<PassDeclaration>& declarations) {
  std::vector<PlannedPass> passes;
  for (const PassDeclaration& declaration : declarations) passes.push_back({declaration, [] {}, 0xffu});
  return passes;
}

std::string failureOf(const std::vector<PassDeclaration>& declarations, const std::vector<ResourceUse>& provided) {
  std::vector<PlannedPass> passes = passesOf(declarations);
  try {
    planFrame(passes, provided);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

// Bits before the second of two passes: the first writes in one way, the second reads in another.
std::uint32_t barriersBetween(Access write, Access read) {
  std::vector<PlannedPass> passes =
      passesOf({{"writer", {}, {{Resource::Color, write}}},
                {"reader", {{Resource::Color, read}}, {{Resource::Picture, Access::Attachment}}}});
  planFrame(passes, {});
  EXPECT_EQ(passes[0].barriersBefore, 0u);
  return passes[1].barriersBefore;
}

TEST(FramePlan, ReaderWithoutWriterIsNamedWithWhatItReads) {
  EXPECT_THAT(failureOf({{"tone", {{Resource::Color, Access::Sampled}}, {}}}, {}),
              AllOf(HasSubstr("tone"), HasSubstr("color")));
  // A later writer is no help, nor is the pass itself.
  EXPECT_THAT(failureOf({{"tone", {{Resource::Color, Access::Sampled}}, {{Resource::Color, Access::ImageStore}}},
                         {"lighting", {}, {{Resource::Color, Access::ImageStore}}}},
                        {}),
              AllOf(HasSubstr("tone"), HasSubstr("color")));
}

TEST(FramePlan, WriterBeforeOrHostSatisfiesAReader) {
  EXPECT_EQ(failureOf({{"lighting", {}, {{Resource::Color, Access::ImageStore}}},
                       {"tone", {{Resource::Color, Access::Sampled}}, {}}},
                      {}),
            "");
  EXPECT_EQ(failureOf({{"tone", {{Resource::Color, Access::Sampled}}, {}}}, {{Resource::Color, Access::Upload}}), "");
}

// Shadows and their like: a frame without them is whole, and one with them waits for them.
TEST(FramePlan, WhatAFrameMayDoWithoutIsWaitedForWhereItIsMade) {
  const PassDeclaration lighting{"lighting", {}, {}, {{Resource::Shadow, Access::Sampled}}};
  EXPECT_EQ(failureOf({lighting}, {}), "");
  std::vector<PlannedPass> passes = passesOf({{"shadow", {}, {{Resource::Shadow, Access::ImageStore}}}, lighting});
  planFrame(passes, {});
  EXPECT_EQ(passes[1].barriersBefore, GL_TEXTURE_FETCH_BARRIER_BIT);
}

TEST(FramePlan, TwoPassesOfOneNameAreRefused) {
  EXPECT_THAT(failureOf({{"mesh", {}, {}}, {"other", {}, {}}, {"mesh", {}, {}}}, {}), HasSubstr("mesh"));
}

TEST(FramePlan, IncoherentWritesGetTheBarrierOfTheNextAccess) {
  for (const Access write : {Access::ImageStore, Access::StorageWrite}) {
    EXPECT_EQ(barriersBetween(write, Access::Sampled), GL_TEXTURE_FETCH_BARRIER_BIT);
    EXPECT_EQ(barriersBetween(write, Access::StorageRead), GL_SHADER_STORAGE_BARRIER_BIT);
    EXPECT_EQ(barriersBetween(write, Access::Uniform), GL_UNIFORM_BARRIER_BIT);
    EXPECT_EQ(barriersBetween(write, Access::Indirect), GL_COMMAND_BARRIER_BIT);
    EXPECT_TRUE(barriersBetween(write, Access::VertexFetch) & GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    EXPECT_TRUE(barriersBetween(write, Access::VertexFetch) & GL_ELEMENT_ARRAY_BARRIER_BIT);
    EXPECT_TRUE(barriersBetween(write, Access::Attachment) & GL_FRAMEBUFFER_BARRIER_BIT);
    EXPECT_EQ(barriersBetween(write, Access::ImageStore), GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    EXPECT_EQ(barriersBetween(write, Access::Upload), GL_BUFFER_UPDATE_BARRIER_BIT);
  }
}

TEST(FramePlan, CoherentWritesGetNoBarrier) {
  for (const Access write : {Access::Attachment, Access::Upload})
    for (const Access read : {Access::Sampled, Access::StorageRead, Access::Uniform, Access::Indirect,
                              Access::VertexFetch, Access::Attachment})
      EXPECT_EQ(barriersBetween(write, read), 0u);
}

TEST(FramePlan, WriteAfterIncoherentWriteGetsABarrierToo) {
  std::vector<PlannedPass> passes = passesOf({{"first", {}, {{Resource::Color, Access::ImageStore}}},
                                              {"second", {}, {{Resource::Color, Access::ImageStore}}}});
  planFrame(passes, {});
  EXPECT_EQ(passes[1].barriersBefore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

TEST(FramePlan, LastWriterDecidesAndOtherResourcesDoNot) {
  std::vector<PlannedPass> passes = passesOf({{"store", {}, {{Resource::Color, Access::ImageStore}}},
                                              {"draw", {}, {{Resource::Color, Access::Attachment}}},
                                              {"read", {{Resource::Color, Access::Sampled}}, {}},
                                              {"aside", {{Resource::Environment, Access::Sampled}}, {}}});
  planFrame(passes, {{Resource::Environment, Access::Upload}});
  EXPECT_NE(passes[1].barriersBefore, 0u);
  EXPECT_EQ(passes[2].barriersBefore, 0u);
  EXPECT_EQ(passes[3].barriersBefore, 0u);
}

// Passes with nothing between them may run side by side.
TEST(FramePlan, OneBarrierServesAllReadersUntilTheNextWrite) {
  const PassDeclaration store{"store", {}, {{Resource::Color, Access::ImageStore}}};
  std::vector<PlannedPass> passes = passesOf({store,
                                              {"a", {{Resource::Color, Access::Sampled}}, {}},
                                              {"b", {{Resource::Color, Access::Sampled}}, {}},
                                              {"c", {{Resource::Color, Access::StorageRead}}, {}},
                                              {"again", {}, {{Resource::Color, Access::ImageStore}}},
                                              {"d", {{Resource::Color, Access::Sampled}}, {}}});
  planFrame(passes, {});
  EXPECT_EQ(passes[1].barriersBefore, GL_TEXTURE_FETCH_BARRIER_BIT);
  EXPECT_EQ(passes[2].barriersBefore, 0u);
  EXPECT_EQ(passes[3].barriersBefore, GL_SHADER_STORAGE_BARRIER_BIT) << "another access";
  EXPECT_EQ(passes[4].barriersBefore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  EXPECT_EQ(passes[5].barriersBefore, GL_TEXTURE_FETCH_BARRIER_BIT);
}

// What a barrier was issued for another resource's sake counts as well.
TEST(FramePlan, WhatIsReadIsNotOvertaken) {
  const PassDeclaration read{"read", {{Resource::Color, Access::Sampled}}, {}};
  const PassDeclaration store{"store", {}, {{Resource::Color, Access::ImageStore}}};
  std::vector<PlannedPass> passes = passesOf({read, store});
  planFrame(passes, {{Resource::Color, Access::Upload}});
  EXPECT_EQ(passes[1].barriersBefore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT) << "its reader may still be running";

  passes = passesOf({{"depth", {}, {{Resource::Depth, Access::ImageStore}}},
                     read,
                     {"other", {{Resource::Depth, Access::Sampled}}, {}},
                     store});
  planFrame(passes, {{Resource::Color, Access::Upload}});
  EXPECT_NE(passes[2].barriersBefore, 0u);
  EXPECT_EQ(passes[3].barriersBefore, 0u) << "a barrier stands between them already";
}

TEST(FramePlan, StoresBeforeTheFrameGetTheirBarrier) {
  std::vector<PlannedPass> passes = passesOf({{"lighting", {{Resource::Environment, Access::Sampled}}, {}}});
  planFrame(passes, {{Resource::Environment, Access::ImageStore}});
  EXPECT_EQ(passes[0].barriersBefore, GL_TEXTURE_FETCH_BARRIER_BIT);
}

TEST(FramePlan, EveryResourceHasANameOfItsOwn) {
  std::vector<std::string> names;
  for (int i = 0; i < kResourceCount; ++i) names.emplace_back(resourceName(static_cast<Resource>(i)));
  for (const std::string& name : names) {
    EXPECT_NE(name, "unknown");
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
  EXPECT_STREQ(resourceName(static_cast<Resource>(kResourceCount)), "unknown"); // kResourceCount counts them all
}

} // namespace
} // namespace brickfield::test
