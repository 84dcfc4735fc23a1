// Where tests find real meshes and scenes, and how a test says aloud that it could not run without them.
#pragma once

#include <filesystem>
#include <string_view>

namespace brickfield::test {

/// The data folder: $BRICKFIELD_DATA, else ../shared/data beside the source tree. It need not exist.
std::filesystem::path dataFolder();
/// A file or folder in it; it need not exist.
std::filesystem::path dataFile(std::string_view name);
/// Whether the data folder exists.
bool hasData();
/// Prints "NOT RUN: TEST: REASON" to stderr, for what a machine lacks and a test cannot do without.
void reportNotRun(std::string_view reason);
/// Whether this file exists; if not, prints "NOT RUN: TEST: FILE missing" to stderr.
bool requireData(std::string_view name);

} // namespace brickfield::test

/// Ends the test, passing but loudly, where the file is missing.
#define BRICKFIELD_NEEDS_DATA(name)                                                                                    \
  do {                                                                                                                 \
    if (!::brickfield::test::requireData(name)) return;                                                                \
  } while (false)
