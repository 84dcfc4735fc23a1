// A vertex array object with a label. One without attributes is what draws need whose shaders fetch from storage
// buffers.
#pragma once

#include <cstddef>
#include <string>

#include "gpu/buffer.h"
#include "gpu/gl.h"

namespace brickfield {

class VertexArray {
public:
  VertexArray() = default;
  explicit VertexArray(std::string label);
  ~VertexArray();
  VertexArray(VertexArray&& other) noexcept;
  VertexArray& operator=(VertexArray&& other) noexcept;

  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  void bind() const;

  void setIndexBuffer(const Buffer& buffer);
  void setVertexBuffer(GLuint binding, const Buffer& buffer, std::size_t strideBytes, std::size_t offsetBytes = 0);
  /// A float attribute; normalized concerns integer types.
  void setAttribute(GLuint attribute, GLuint binding, int components, GLenum type, std::size_t offsetBytes,
                    bool normalized = false);
  void setIntegerAttribute(GLuint attribute, GLuint binding, int components, GLenum type, std::size_t offsetBytes);

private:
  std::string label_;
  GLuint id_ = 0;
};

} // namespace brickfield
