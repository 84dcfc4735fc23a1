// Vertex array objects.
#include "gpu/vertex_array.h"

#include <utility>

#include "gpu/check.h"

namespace brickfield {

VertexArray::VertexArray(std::string label) : label_(std::move(label)) {
  glCreateVertexArrays(1, &id_);
  labelObject(GL_VERTEX_ARRAY, id_, label_);
}

VertexArray::~VertexArray() {
  if (id_) glDeleteVertexArrays(1, &id_);
}

VertexArray::VertexArray(VertexArray&& other) noexcept
    : label_(std::move(other.label_)), id_(std::exchange(other.id_, 0)) {}

VertexArray& VertexArray::operator=(VertexArray&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  return *this;
}

void VertexArray::bind() const { glBindVertexArray(id_); }

void VertexArray::setIndexBuffer(const Buffer& buffer) { glVertexArrayElementBuffer(id_, buffer.id()); }

void VertexArray::setVertexBuffer(GLuint binding, const Buffer& buffer, std::size_t strideBytes,
                                  std::size_t offsetBytes) {
  glVertexArrayVertexBuffer(id_, binding, buffer.id(), static_cast<GLintptr>(offsetBytes),
                            static_cast<GLsizei>(strideBytes));
}

void VertexArray::setAttribute(GLuint attribute, GLuint binding, int components, GLenum type, std::size_t offsetBytes,
                               bool normalized) {
  glEnableVertexArrayAttrib(id_, attribute);
  glVertexArrayAttribBinding(id_, attribute, binding);
  glVertexArrayAttribFormat(id_, attribute, components, type, normalized ? GL_TRUE : GL_FALSE,
                            static_cast<GLuint>(offsetBytes));
}

void VertexArray::setIntegerAttribute(GLuint attribute, GLuint binding, int components, GLenum type,
                                      std::size_t offsetBytes) {
  glEnableVertexArrayAttrib(id_, attribute);
  glVertexArrayAttribBinding(id_, attribute, binding);
  glVertexArrayAttribIFormat(id_, attribute, components, type, static_cast<GLuint>(offsetBytes));
}

} // namespace brickfield
