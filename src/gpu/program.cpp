// Compiles and links programs, sets uniforms, asks the driver for layouts.
#include "gpu/program.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/type_ptr.hpp>

#include "core/error.h"
#include "gpu/check.h"
#include "gpu/shader_source.h"

namespace brickfield {

namespace {

// A driver that gives up says so once for every use of a name; the first messages tell the cause.
constexpr std::size_t kMostMessages = 8;

class Shader {
public:
  explicit Shader(GLenum stage) : id_(glCreateShader(stage)) {}
  ~Shader() { glDeleteShader(id_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  GLuint id() const { return id_; }

private:
  GLuint id_;
};

std::string oneLine(std::vector<std::string> messages, const char* otherwise) {
  if (messages.empty()) return otherwise;
  if (messages.size() > kMostMessages) {
    messages.resize(kMostMessages);
    messages.push_back("...");
  }
  return fmt::format("{}", fmt::join(messages, "; "));
}

std::string shaderLog(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 0)), '\0');
  if (length > 0) glGetShaderInfoLog(shader, length, &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(length, 0)));
  return log;
}

std::string programLog(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 0)), '\0');
  if (length > 0) glGetProgramInfoLog(program, length, &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(length, 0)));
  return log;
}

void compile(const std::string& label, const Shader& shader, const StageSource& source) {
  const char* text = source.text.c_str();
  const auto length = static_cast<GLint>(source.text.size());
  glShaderSource(shader.id(), 1, &text, &length);
  glCompileShader(shader.id());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled) return;
  throw Failure(fmt::format("program \"{}\": {}", label,
                            oneLine(readableLog(shaderLog(shader.id()), source.files), "does not compile")));
}

} // namespace

Program::Program(std::string label, const std::vector<StageSource>& stages) : label_(std::move(label)) {
  id_ = glCreateProgram();
  try {
    for (const StageSource& source : stages) {
      const Shader shader(source.stage);
      compile(label_, shader, source);
      glAttachShader(id_, shader.id()); // Marked for deletion by its scope, it lives as long as the program.
    }
    glLinkProgram(id_);
    GLint linked = GL_FALSE;
    glGetProgramiv(id_, GL_LINK_STATUS, &linked);
    if (!linked) {
      const std::vector<std::string> files = stages.size() == 1 ? stages.front().files : std::vector<std::string>();
      throw Failure(
          fmt::format("program \"{}\": linking: {}", label_, oneLine(readableLog(programLog(id_), files), "failed")));
    }
  } catch (...) {
    glDeleteProgram(id_);
    throw;
  }
  labelObject(GL_PROGRAM, id_, label_);
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept
    : label_(std::move(other.label_)), id_(std::exchange(other.id_, 0)), locations_(std::move(other.locations_)) {}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  std::swap(locations_, other.locations_);
  return *this;
}

GLint Program::location(std::string_view name) const {
  if (const auto found = locations_.find(name); found != locations_.end()) return found->second;
  std::string key(name);
  const GLint location = glGetUniformLocation(id_, key.c_str());
  locations_.emplace(std::move(key), location);
  return location;
}

void Program::set(std::string_view name, bool value) { glProgramUniform1i(id_, location(name), value ? 1 : 0); }
void Program::set(std::string_view name, int value) { glProgramUniform1i(id_, location(name), value); }
void Program::set(std::string_view name, std::uint32_t value) { glProgramUniform1ui(id_, location(name), value); }
void Program::set(std::string_view name, float value) { glProgramUniform1f(id_, location(name), value); }
void Program::set(std::string_view name, glm::vec2 value) { glProgramUniform2fv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::vec3 value) { glProgramUniform3fv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::vec4 value) { glProgramUniform4fv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::ivec2 value) { glProgramUniform2iv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::ivec3 value) { glProgramUniform3iv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::ivec4 value) { glProgramUniform4iv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::uvec2 value) { glProgramUniform2uiv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::uvec3 value) { glProgramUniform3uiv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, glm::uvec4 value) { glProgramUniform4uiv(id_, location(name), 1, &value.x); }
void Program::set(std::string_view name, const glm::mat3& value) {
  glProgramUniformMatrix3fv(id_, location(name), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(std::string_view name, const glm::mat4& value) {
  glProgramUniformMatrix4fv(id_, location(name), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(std::string_view name, const std::vector<float>& values) {
  glProgramUniform1fv(id_, location(name), static_cast<GLsizei>(values.size()), values.data());
}
void Program::set(std::string_view name, const std::vector<glm::vec4>& values) {
  if (!values.empty()) glProgramUniform4fv(id_, location(name), static_cast<GLsizei>(values.size()), &values[0].x);
}

Program::BlockLayout Program::blockLayout(std::string_view block, bool storage) const {
  const GLenum blocks = storage ? GL_SHADER_STORAGE_BLOCK : GL_UNIFORM_BLOCK;
  const GLenum variables = storage ? GL_BUFFER_VARIABLE : GL_UNIFORM;
  const GLuint index = glGetProgramResourceIndex(id_, blocks, std::string(block).c_str());
  if (index == GL_INVALID_INDEX) throw Failure(fmt::format("program \"{}\": has no block {}", label_, block));

  const auto query = [&](GLenum interface, GLuint resource, GLenum property) {
    GLint value = 0;
    glGetProgramResourceiv(id_, interface, resource, 1, &property, 1, nullptr, &value);
    return value;
  };
  BlockLayout layout;
  layout.bytes = query(blocks, index, GL_BUFFER_DATA_SIZE);
  std::vector<GLint> members(static_cast<std::size_t>(query(blocks, index, GL_NUM_ACTIVE_VARIABLES)));
  const GLenum active = GL_ACTIVE_VARIABLES;
  glGetProgramResourceiv(id_, blocks, index, 1, &active, static_cast<GLsizei>(members.size()), nullptr, members.data());
  for (const GLint member : members) {
    const auto resource = static_cast<GLuint>(member);
    std::string name(static_cast<std::size_t>(query(variables, resource, GL_NAME_LENGTH)), '\0');
    GLsizei length = 0;
    glGetProgramResourceName(id_, variables, resource, static_cast<GLsizei>(name.size()), &length, name.data());
    name.resize(static_cast<std::size_t>(length));
    layout.offsets[name] = query(variables, resource, GL_OFFSET);
    if (storage)
      layout.arrayStride = std::max(layout.arrayStride, query(variables, resource, GL_TOP_LEVEL_ARRAY_STRIDE));
  }
  return layout;
}

glm::ivec3 Program::groupSize() const {
  glm::ivec3 size{0};
  glGetProgramiv(id_, GL_COMPUTE_WORK_GROUP_SIZE, &size.x);
  return size;
}

void Program::dispatchOver(glm::ivec3 invocations) const {
  if (glm::any(glm::lessThanEqual(invocations, glm::ivec3(0)))) return;
  const glm::ivec3 size = groupSize();
  const glm::uvec3 groups((invocations + size - 1) / size);
  use();
  glDispatchCompute(groups.x, groups.y, groups.z);
}

} // namespace brickfield
