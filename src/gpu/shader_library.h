// All programs of one context, made from the files of a shader folder, cached by source and defines, replaced in place
// when files change.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/gl.h"
#include "gpu/program.h"

namespace brickfield {

struct ProgramSource {
  std::string label;
  std::map<GLenum, std::string> stages;       ///< GL_VERTEX_SHADER and so on -> path relative to the shader root
  std::map<std::string, std::string> defines; ///< name -> value
  std::vector<std::string> extensions;        ///< each becomes `#extension NAME : require`
};

class ShaderLibrary {
public:
  /// error BadInput: the root is no folder
  explicit ShaderLibrary(std::filesystem::path root);
  ~ShaderLibrary();
  ShaderLibrary(ShaderLibrary&&) noexcept;
  ShaderLibrary& operator=(ShaderLibrary&&) noexcept;

  /// The program of this source; the same one for the same stages, defines and extensions, whatever the label.
  /// error Failure, one line with file:line: missing file or include, compiler or linker error
  std::shared_ptr<Program> load(const ProgramSource& source);

  /// Compiles programs anew whose files changed on disk since they were read. A program is replaced (same object, other
  /// id, uniforms unset) only if everything compiled, else it stays as it was.
  /// returns one line for each program that changed files: "reloaded LABEL", or the error
  std::vector<std::string> reloadChanged();

  const std::filesystem::path& root() const { return root_; }
  std::size_t programCount() const { return entries_.size(); }

private:
  struct Entry;
  std::filesystem::path root_;
  std::map<std::string, std::unique_ptr<Entry>> entries_;
};

/// The folder of shaders: $BRICKFIELD_SHADERS, else `shaders` beside the executable, else ../share/brickfield/shaders.
/// error BadInput that names what was tried
std::filesystem::path findShaderRoot();

/// Every *.glsl under the root, relative to it, sorted.
std::vector<std::string> allShaderFiles(const std::filesystem::path& root);

} // namespace brickfield
