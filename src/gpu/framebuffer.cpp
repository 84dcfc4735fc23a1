// Framebuffer objects and what makes them incomplete.
#include "gpu/framebuffer.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "gpu/check.h"

namespace brickfield {

namespace {

const char* statusText(GLenum status) {
  switch (status) {
  case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
    return "an attachment cannot be rendered to";
  case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
    return "no attachment";
  case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
    return "an output has no attachment";
  case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
    return "attachments differ in samples";
  case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
    return "attachments differ in being layered";
  case GL_FRAMEBUFFER_UNSUPPORTED:
    return "this driver cannot combine the formats";
  default:
    return "incomplete for an unknown reason";
  }
}

bool isColor(GLenum point) { return point >= GL_COLOR_ATTACHMENT0 && point <= GL_COLOR_ATTACHMENT31; }

} // namespace

Framebuffer::Framebuffer(std::string label, std::span<const Attachment> attachments) : label_(std::move(label)) {
  for (const Attachment& attachment : attachments)
    if (!attachment.texture || !*attachment.texture)
      throw Failure(fmt::format("framebuffer \"{}\": an attachment has no texture", label_));
  glCreateFramebuffers(1, &id_);
  labelObject(GL_FRAMEBUFFER, id_, label_);
  std::vector<GLenum> outputs;
  for (const Attachment& attachment : attachments) {
    const Texture& texture = *attachment.texture;
    if (attachment.layer < 0)
      glNamedFramebufferTexture(id_, attachment.point, texture.id(), attachment.level);
    else
      glNamedFramebufferTextureLayer(id_, attachment.point, texture.id(), attachment.level, attachment.layer);
    const glm::ivec2 extent(texture.extent(attachment.level));
    extent_ = &attachment == attachments.data() ? extent : glm::min(extent_, extent);
    if (!isColor(attachment.point)) continue;
    const std::size_t index = attachment.point - GL_COLOR_ATTACHMENT0;
    if (outputs.size() <= index) outputs.resize(index + 1, GL_NONE);
    outputs[index] = attachment.point;
  }
  if (outputs.empty()) outputs.push_back(GL_NONE);
  glNamedFramebufferDrawBuffers(id_, static_cast<GLsizei>(outputs.size()), outputs.data());
  glNamedFramebufferReadBuffer(id_, outputs.front());
  requireComplete();
}

Framebuffer::Framebuffer(std::string label, std::initializer_list<Attachment> attachments)
    : Framebuffer(std::move(label), std::span<const Attachment>(attachments.begin(), attachments.size())) {}

Framebuffer::Framebuffer(std::string label, glm::ivec2 extent, int layers, int samples)
    : label_(std::move(label)), extent_(extent) {
  glCreateFramebuffers(1, &id_);
  labelObject(GL_FRAMEBUFFER, id_, label_);
  glNamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_WIDTH, extent.x);
  glNamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_HEIGHT, extent.y);
  glNamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_LAYERS, layers);
  glNamedFramebufferParameteri(id_, GL_FRAMEBUFFER_DEFAULT_SAMPLES, samples);
  requireComplete();
}

void Framebuffer::requireComplete() {
  const GLenum status = glCheckNamedFramebufferStatus(id_, GL_DRAW_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return;
  glDeleteFramebuffers(1, &id_);
  throw Failure(fmt::format("framebuffer \"{}\": {}", label_, statusText(status)));
}

Framebuffer::~Framebuffer() {
  if (id_) glDeleteFramebuffers(1, &id_);
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept
    : label_(std::move(other.label_)), id_(std::exchange(other.id_, 0)), extent_(other.extent_) {}

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  std::swap(extent_, other.extent_);
  return *this;
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glViewport(0, 0, extent_.x, extent_.y);
}

void Framebuffer::clearColor(int index, glm::vec4 value) { glClearNamedFramebufferfv(id_, GL_COLOR, index, &value.x); }
void Framebuffer::clearColor(int index, glm::uvec4 value) {
  glClearNamedFramebufferuiv(id_, GL_COLOR, index, &value.x);
}
void Framebuffer::clearDepth(float depth) { glClearNamedFramebufferfv(id_, GL_DEPTH, 0, &depth); }

} // namespace brickfield
