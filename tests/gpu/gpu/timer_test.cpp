// Scopes are timed in order, nested ones inside their parents, by both methods.
#include "gpu/timer.h"

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class TimerTest : public GlTest, public ::testing::WithParamInterface<bool> {
protected:
  // Both methods run on every machine; which one a driver is better served by is not the question here.
  static ContextInfo info() {
    ContextInfo info = context().info();
    info.isSoftware = GetParam();
    return info;
  }
  static void work() {
    Buffer buffer("work", std::size_t{1} << 22);
    for (std::uint32_t i = 0; i < 4; ++i) buffer.clear(i);
  }
};
INSTANTIATE_TEST_SUITE_P(Method, TimerTest, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Clock" : "Queries"; });

TEST_P(TimerTest, ScopesComeBackInOrderWithTheirDepth) {
  FrameTimers timers(info());
  timers.beginFrame();
  {
    const auto frame = timers.scope("frame");
    {
      const auto first = timers.scope("first");
      work();
    }
    const auto second = timers.scope("second");
    work();
  }
  const std::vector<PassTime> times = timers.results();
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].name, "frame");
  EXPECT_EQ(times[1].name, "first");
  EXPECT_EQ(times[2].name, "second");
  EXPECT_EQ(times[0].depth, 0);
  EXPECT_EQ(times[1].depth, 1);
  EXPECT_GT(times[1].milliseconds, 0);
  EXPECT_GE(times[0].milliseconds, times[1].milliseconds + times[2].milliseconds);
  EXPECT_LT(times[0].milliseconds, 60000) << "an unset timestamp was read";
  EXPECT_GT(times[1].recordMilliseconds, 0);
  EXPECT_GE(times[0].recordMilliseconds, times[1].recordMilliseconds + times[2].recordMilliseconds);
}

TEST_P(TimerTest, FinishedFramesAreReadLater) {
  FrameTimers timers(info());
  EXPECT_TRUE(timers.finishedResults().empty());
  for (int frame = 0; frame < 10; ++frame) {
    timers.beginFrame();
    const auto scope = timers.scope("pass " + std::to_string(frame));
    work();
  }
  glFinish();
  timers.beginFrame();
  EXPECT_TRUE(timers.results().empty());
  const std::vector<PassTime> times = timers.finishedResults();
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].name, "pass 9");
}

TEST_P(TimerTest, DisabledScopesLeaveNothing) {
  FrameTimers timers(info());
  timers.setEnabled(false);
  timers.beginFrame();
  { const auto scope = timers.scope("pass"); }
  EXPECT_TRUE(timers.results().empty());
}

TEST_P(TimerTest, OpenScopeIsAFailure) {
  FrameTimers timers(info());
  timers.beginFrame();
  const auto scope = timers.scope("pass");
  EXPECT_THROW(timers.results(), Failure);
  EXPECT_THROW(timers.beginFrame(), Failure);
}

TEST_P(TimerTest, GroupsAreBalanced) {
  {
    const DebugGroup outer("frame");
    const DebugGroup inner("pass");
    GLint depth = 0;
    glGetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &depth);
    EXPECT_EQ(depth, 3); // the default group counts
  }
  GLint depth = 0;
  glGetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &depth);
  EXPECT_EQ(depth, 1);
}

} // namespace
} // namespace brickfield::test
