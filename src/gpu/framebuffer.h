// Render targets: a framebuffer object with a label over textures that it does not own.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/gl.h"
#include "gpu/texture.h"

namespace brickfield {

struct Attachment {
  GLenum point = GL_COLOR_ATTACHMENT0; ///< GL_COLOR_ATTACHMENTi, GL_DEPTH_ATTACHMENT, GL_DEPTH_STENCIL_ATTACHMENT
  const Texture* texture = nullptr;
  int level = 0;
  int layer = -1; ///< -1 attaches all layers
};

/// Fragment output i goes to GL_COLOR_ATTACHMENTi. The textures must outlive it.
class Framebuffer {
public:
  Framebuffer() = default;
  /// error Failure that names the label and says what makes it incomplete
  Framebuffer(std::string label, std::span<const Attachment> attachments);
  Framebuffer(std::string label, std::initializer_list<Attachment> attachments);
  /// Without attachments, for passes that only write memory.
  Framebuffer(std::string label, glm::ivec2 extent, int layers = 0, int samples = 0);
  ~Framebuffer();
  Framebuffer(Framebuffer&& other) noexcept;
  Framebuffer& operator=(Framebuffer&& other) noexcept;

  GLuint id() const { return id_; }
  const std::string& label() const { return label_; }
  glm::ivec2 extent() const { return extent_; }
  explicit operator bool() const { return id_ != 0; }

  /// Binds it for drawing and sets the viewport to its whole extent.
  void bind() const;
  /// Clears fragment output `index`; the kind of value must be that of the attachment.
  void clearColor(int index, glm::vec4 value);
  void clearColor(int index, glm::uvec4 value);
  void clearDepth(float depth);

private:
  void requireComplete();

  std::string label_;
  GLuint id_ = 0;
  glm::ivec2 extent_{0};
};

} // namespace brickfield
