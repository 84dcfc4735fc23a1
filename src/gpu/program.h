// A linked program: its uniforms by name, its block layouts. Programs come from a ShaderLibrary, which may replace what
// is behind one when its files change.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/gl.h"

namespace brickfield {

/// Text of one stage, ready for the driver; files[i] is the name of source string i, which `#line` refers to.
struct StageSource {
  GLenum stage = GL_COMPUTE_SHADER;
  std::string text;
  std::vector<std::string> files;
};

class Program {
public:
  /// error Failure, one line: the label, then for each message of the compiler file:line and text
  Program(std::string label, const std::vector<StageSource>& stages);
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  GLuint id() const { return id_; }
  const std::string& label() const { return label_; }
  void use() const { glUseProgram(id_); }

  /// Sets a uniform of the default block. A name that the program does not use is ignored, because variants drop
  /// uniforms; a wrong type is a GL error. Values do not survive a reload: set them every frame.
  void set(std::string_view name, bool value);
  void set(std::string_view name, int value);
  void set(std::string_view name, std::uint32_t value);
  void set(std::string_view name, float value);
  void set(std::string_view name, glm::vec2 value);
  void set(std::string_view name, glm::vec3 value);
  void set(std::string_view name, glm::vec4 value);
  void set(std::string_view name, glm::ivec2 value);
  void set(std::string_view name, glm::ivec3 value);
  void set(std::string_view name, glm::ivec4 value);
  void set(std::string_view name, glm::uvec2 value);
  void set(std::string_view name, glm::uvec3 value);
  void set(std::string_view name, glm::uvec4 value);
  void set(std::string_view name, const glm::mat3& value);
  void set(std::string_view name, const glm::mat4& value);
  void set(std::string_view name, const std::vector<float>& values);
  void set(std::string_view name, const std::vector<glm::vec4>& values);
  bool hasUniform(std::string_view name) const { return location(name) >= 0; }

  /// What the driver made of a block: byte offset by the member's full name as GL gives it ("Params.eye",
  /// "items[0].box").
  struct BlockLayout {
    std::map<std::string, int, std::less<>> offsets;
    int bytes = 0;       ///< the block's smallest size
    int arrayStride = 0; ///< bytes between elements of a trailing array of structs, 0 without one
  };
  /// storage  true for `buffer`, false for `uniform` blocks
  /// error    Failure for a block that the program does not use
  BlockLayout blockLayout(std::string_view block, bool storage) const;

  /// Work group size of a compute program.
  glm::ivec3 groupSize() const;
  /// Runs it over at least this many invocations, in whole groups; uses the program.
  void dispatchOver(glm::ivec3 invocations) const;

private:
  GLint location(std::string_view name) const;

  struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>()(text); }
  };
  std::string label_;
  GLuint id_ = 0;
  mutable std::unordered_map<std::string, GLint, TextHash, std::equal_to<>> locations_;
};

} // namespace brickfield
