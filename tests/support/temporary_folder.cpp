// Temporary folders by mkdtemp.
#include "tests/support/temporary_folder.h"

#include <stdexcept>
#include <string>

#include <stdlib.h>

#include "core/files.h"

namespace brickfield::test {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "brickfield-XXXXXX").string();
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder: " + pattern);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ec;
  fs::remove_all(path_, ec);
}

fs::path TemporaryFolder::write(std::string_view name, std::string_view text) const {
  const fs::path path = path_ / name;
  fs::create_directories(path.parent_path());
  writeFile(path, text);
  return path;
}

} // namespace brickfield::test
