// The suite's context.
#include "tests/support/gl_fixture.h"

#include "core/error.h"

namespace brickfield::test {

namespace {
// gtest knows no object that lives as long as a suite but statics.
std::unique_ptr<Context>& suiteContext() {
  static std::unique_ptr<Context> context;
  return context;
}
} // namespace

void GlTest::SetUpTestSuite() {
  try {
    suiteContext() = Context::createHeadless(-1, true);
  } catch (const Error& error) {
    ADD_FAILURE() << error.what();
  }
}

void GlTest::TearDownTestSuite() { suiteContext().reset(); }

void GlTest::SetUp() {
  ASSERT_NE(suiteContext(), nullptr) << "no OpenGL context";
  suiteContext()->makeCurrent();
}

void GlTest::TearDown() {
  if (!suiteContext()) return;
  suiteContext()->makeCurrent();
  for (const std::string& error : suiteContext()->takeGlErrors()) ADD_FAILURE() << "GL error: " << error;
}

Context& GlTest::context() { return *suiteContext(); }

} // namespace brickfield::test
