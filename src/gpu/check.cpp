// Object labels and the check after an allocation.
#include "gpu/check.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

void labelObject(GLenum kind, GLuint id, std::string_view label) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_LABEL_LENGTH, &limit);
  const auto length = std::min(static_cast<GLsizei>(label.size()), std::max(limit - 1, 0));
  glObjectLabel(kind, id, length, label.data());
}

void requireNoGlError(std::string_view what) {
  const GLenum code = glGetError();
  if (code == GL_NO_ERROR) return;
  throw Failure(code == GL_OUT_OF_MEMORY ? fmt::format("{}: out of GPU memory", what)
                                         : fmt::format("{}: GL error {:#x} here or earlier", what, code));
}

} // namespace brickfield
