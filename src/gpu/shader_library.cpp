// The cache of programs and their reload.
#include "gpu/shader_library.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/files.h"
#include "gpu/shader_source.h"

namespace brickfield {

namespace fs = std::filesystem;

struct ShaderLibrary::Entry {
  ProgramSource source;
  std::shared_ptr<Program> program;
  FileTimes files; // all that the last try looked for
};

namespace {

// Parts are separated by characters that stand in no path and no define.
std::string keyOf(const ProgramSource& source) {
  std::string key;
  for (const auto& [stage, path] : source.stages) key += fmt::format("{}\x1f{}\x1e", stage, path);
  for (const auto& [name, value] : source.defines) key += fmt::format("{}\x1f{}\x1d", name, value);
  for (const std::string& extension : source.extensions) key += extension + '\x1c';
  return key;
}

// files  gets every file that was looked for, also when this throws
Program build(const fs::path& root, const ProgramSource& source, FileTimes& files) {
  std::vector<StageSource> stages;
  for (const auto& [stage, path] : source.stages) {
    try {
      ShaderText text = assembleShader(root, path, {source.extensions, source.defines}, &files);
      stages.push_back({stage, std::move(text.text), std::move(text.files)});
    } catch (const Failure& error) {
      throw Failure(fmt::format("program \"{}\": {}", source.label, error.what()));
    }
  }
  return Program(source.label, stages);
}

} // namespace

ShaderLibrary::ShaderLibrary(fs::path root) : root_(std::move(root)) {
  std::error_code ec;
  if (!fs::is_directory(root_, ec)) throw BadInput(root_.string(), "", "no folder of shaders");
}
ShaderLibrary::~ShaderLibrary() = default;
ShaderLibrary::ShaderLibrary(ShaderLibrary&&) noexcept = default;
ShaderLibrary& ShaderLibrary::operator=(ShaderLibrary&&) noexcept = default;

std::shared_ptr<Program> ShaderLibrary::load(const ProgramSource& source) {
  std::string key = keyOf(source);
  if (const auto found = entries_.find(key); found != entries_.end()) return found->second->program;
  auto entry = std::make_unique<Entry>();
  entry->source = source;
  entry->program = std::make_shared<Program>(build(root_, source, entry->files));
  return entries_.emplace(std::move(key), std::move(entry)).first->second->program;
}

std::vector<std::string> ShaderLibrary::reloadChanged() {
  std::vector<std::string> messages;
  for (auto& [key, entry] : entries_) {
    const bool changed = std::ranges::any_of(
        entry->files, [&](const auto& file) { return changeTime(root_ / file.first) != file.second; });
    if (!changed) continue;
    FileTimes files; // If it fails, what failed is among the files looked for, so watching these is enough.
    try {
      *entry->program = build(root_, entry->source, files);
      messages.push_back(fmt::format("reloaded {}", entry->source.label));
    } catch (const Failure& error) {
      messages.push_back(error.what());
    }
    entry->files = std::move(files);
  }
  return messages;
}

fs::path findShaderRoot() {
  std::vector<std::string> tried;
  const auto isRoot = [&](const fs::path& path) {
    std::error_code ec;
    if (fs::is_directory(path, ec)) return true;
    tried.push_back(path.string());
    return false;
  };
  // Who sets the variable wants that folder and no other.
  if (const char* given = std::getenv("BRICKFIELD_SHADERS"); given && *given) {
    if (isRoot(given)) return given;
    throw BadInput("BRICKFIELD_SHADERS", given, "no folder of shaders");
  }
  const fs::path folder = executableFolder();
  for (const fs::path& path : {folder / "shaders", (folder / "../share/brickfield/shaders").lexically_normal()})
    if (isRoot(path)) return path;
  throw BadInput("shaders", "",
                 fmt::format("no folder of shaders at {}; BRICKFIELD_SHADERS is not set", fmt::join(tried, ", ")));
}

std::vector<std::string> allShaderFiles(const fs::path& root) {
  std::error_code ec;
  if (!fs::is_directory(root, ec)) throw BadInput(root.string(), "", "no folder of shaders");
  std::vector<std::string> paths;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file() && entry.path().extension() == ".glsl")
      paths.push_back(entry.path().lexically_relative(root).generic_string());
  std::ranges::sort(paths);
  return paths;
}

} // namespace brickfield
