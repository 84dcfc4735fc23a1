// How contexts are made, what they report, and that several live side by side.
#include "gpu/context.h"

#include <thread>

#include "core/error.h"
#include "gpu/buffer.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class ContextTest : public GlTest {};

TEST_F(ContextTest, InfoNamesARealDriver) {
  const ContextInfo& info = context().info();
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_FALSE(info.vendor.empty());
  EXPECT_FALSE(info.platform.empty());
  EXPECT_GE(std::stof(info.version), 4.5f) << info.version;
  EXPECT_GE(std::stof(info.glslVersion), 4.5f) << info.glslVersion;
  GLint profile = 0;
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_TRUE(profile & GL_CONTEXT_CORE_PROFILE_BIT);
}

TEST_F(ContextTest, SoftwareIsKnownByItsName) {
  EXPECT_EQ(context().info().isSoftware, context().info().renderer.find("llvmpipe") != std::string::npos);
}

TEST_F(ContextTest, DeviceOutOfRangeIsOneLineOfBadInput) {
  try {
    Context::createHeadless(9999);
    FAIL() << "a context on device 9999";
  } catch (const BadInput& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("EGL device 9999: no such device"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
  GLint major = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  EXPECT_EQ(major, 4) << "the failure left another context current";
}

TEST_F(ContextTest, ListedDevicesWorkOrSayWhyNot) {
  for (const DeviceInfo& device : listDevices()) {
    if (device.error.empty())
      EXPECT_EQ(Context::createHeadless(device.index)->info().renderer, device.context.renderer);
    else
      EXPECT_THROW(Context::createHeadless(device.index), BadInput);
  }
  context().makeCurrent();
}

TEST_F(ContextTest, ListingLeavesTheCurrentContext) {
  const Buffer mine("mine", std::vector<int>{7});
  listDevices();
  EXPECT_TRUE(glIsBuffer(mine.id()));
}

TEST_F(ContextTest, TwoContextsInOneThreadAreIndependent) {
  Buffer first("first", std::vector<int>{1, 2, 3});
  {
    const auto second = Context::createHeadless(-1, true);
    const Buffer other("other", std::vector<int>{9});
    EXPECT_EQ(other.read<int>(), std::vector<int>{9});
    glEnable(GL_SCISSOR_TEST);
    context().makeCurrent();
    EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
    EXPECT_EQ(first.read<int>(), (std::vector<int>{1, 2, 3}));
    second->makeCurrent();
    EXPECT_TRUE(second->takeGlErrors().empty());
  }
  context().makeCurrent(); // The other one's end must not have taken the display along.
  EXPECT_EQ(first.read<int>(), (std::vector<int>{1, 2, 3}));
}

TEST_F(ContextTest, ContextsWorkInSeveralThreadsAtOnce) {
  constexpr int kThreads = 3, kRounds = 20;
  std::vector<int> sums(kThreads, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] {
      const auto own = Context::createHeadless();
      for (int round = 0; round < kRounds; ++round)
        sums[static_cast<std::size_t>(t)] += Buffer("b", std::vector<int>{t, round}).read<int>().front();
    });
  for (std::thread& thread : threads) thread.join();
  for (int t = 0; t < kThreads; ++t) EXPECT_EQ(sums[static_cast<std::size_t>(t)], t * kRounds);
}

TEST_F(ContextTest, ErrorsAreCollectedOnceAndCounted) {
  const std::uint64_t before = context().debugErrorCount();
  glBindBuffer(GL_TEXTURE_2D, 0); // no such target
  EXPECT_GT(context().debugErrorCount(), before);
  const std::vector<std::string> errors = context().takeGlErrors();
  EXPECT_NE(std::find(errors.begin(), errors.end(), "GL_INVALID_ENUM"), errors.end());
  EXPECT_GE(errors.size(), 2u) << "the debug output's text is missing";
  EXPECT_TRUE(context().takeGlErrors().empty());
}

TEST_F(ContextTest, ErrorsAreCollectedWithoutDebugOutput) {
  {
    const auto plain = Context::createHeadless(-1, false);
    glBindBuffer(GL_TEXTURE_2D, 0);
    EXPECT_EQ(plain->takeGlErrors(), std::vector<std::string>{"GL_INVALID_ENUM"});
    EXPECT_TRUE(plain->takeGlErrors().empty());
    EXPECT_EQ(plain->debugErrorCount(), 0u);
  }
  context().makeCurrent();
}

TEST_F(ContextTest, ErrorTextsHaveALimit) {
  for (std::size_t i = 0; i < 2 * Context::kMostErrors; ++i) glBindBuffer(GL_TEXTURE_2D, 0);
  EXPECT_LE(context().takeGlErrors().size(), 2 * Context::kMostErrors);
  EXPECT_GE(context().debugErrorCount(), 2 * Context::kMostErrors);
}

TEST_F(ContextTest, HostContextIsAdoptedAsItIs) {
  glEnable(GL_SCISSOR_TEST);
  {
    const auto host = Context::adoptCurrent();
    EXPECT_EQ(host->info().platform, "host");
    EXPECT_EQ(host->info().renderer, context().info().renderer);
    host->release(); // not ours to release
    EXPECT_TRUE(glIsEnabled(GL_SCISSOR_TEST));
  }
  EXPECT_TRUE(glIsEnabled(GL_SCISSOR_TEST));
  glDisable(GL_SCISSOR_TEST);
}

TEST_F(ContextTest, AdoptingNothingIsBadInput) {
  context().release();
  try {
    Context::adoptCurrent();
    FAIL() << "a context out of nothing";
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(), "OpenGL 4.5 context: host: no context is current in this thread");
  }
}

} // namespace
} // namespace brickfield::test
