// A gtest fixture with a headless OpenGL context, one a test suite. A machine without one fails the tests: it skips
// none.
#pragma once

#include <memory>

#include <gtest/gtest.h>

#include "gpu/context.h"
#include "gpu/gl.h"

namespace brickfield::test {

/// Before each test the suite's context (a debug one) is current; after it, GL errors fail the test.
class GlTest : public ::testing::Test {
protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;
  void TearDown() override;

  /// The suite's context.
  static Context& context();
};

} // namespace brickfield::test
