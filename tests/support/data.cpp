// The data folder and the loud absence.
#include "tests/support/data.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace brickfield::test {

namespace fs = std::filesystem;

fs::path dataFolder() {
  if (const char* given = std::getenv("BRICKFIELD_DATA"); given && *given) return given;
  return fs::path(BRICKFIELD_SOURCE_DIR).parent_path() / "shared" / "data";
}

fs::path dataFile(std::string_view name) { return dataFolder() / name; }

bool hasData() {
  std::error_code ec;
  return fs::is_directory(dataFolder(), ec);
}

void reportNotRun(std::string_view reason) {
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = test ? std::string(test->test_suite_name()) + "." + test->name() : "no test";
  std::fprintf(stderr, "NOT RUN: %s: %.*s\n", name.c_str(), static_cast<int>(reason.size()), reason.data());
}

bool requireData(std::string_view name) {
  const fs::path path = dataFile(name);
  std::error_code ec;
  if (fs::exists(path, ec)) return true;
  reportNotRun(path.string() + " missing");
  return false;
}

} // namespace brickfield::test
