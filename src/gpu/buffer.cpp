// Immutable GL buffers; growth makes a new one and copies on the GPU.
#include "gpu/buffer.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "gpu/check.h"

namespace brickfield {

namespace {
// Storage of no bytes is an error in GL, and an empty list must still be bindable.
constexpr std::size_t kLeastStorageBytes = 16;
} // namespace

Buffer::Buffer(std::string label, std::size_t bytes, GLbitfield flags)
    : label_(std::move(label)), bytes_(bytes), flags_(flags) {
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(std::max(bytes, kLeastStorageBytes)), nullptr, flags);
  labelObject(GL_BUFFER, id_, label_);
  try {
    requireNoGlError(fmt::format("buffer \"{}\" of {} bytes", label_, bytes));
  } catch (...) {
    glDeleteBuffers(1, &id_);
    throw;
  }
}

Buffer::Buffer(std::string label, std::span<const std::byte> content, GLbitfield flags)
    : Buffer(std::move(label), content.size(), flags) {
  if (content.empty()) return;
  if (flags & GL_DYNAMIC_STORAGE_BIT) {
    upload(0, content);
  } else { // Storage that the CPU may not write later is filled through a copy.
    const Buffer staging(label_ + " staging", content);
    copyFrom(staging, 0, 0, content.size());
  }
}

Buffer::~Buffer() {
  if (id_) glDeleteBuffers(1, &id_);
}

Buffer::Buffer(Buffer&& other) noexcept
    : label_(std::move(other.label_)),
      id_(std::exchange(other.id_, 0)),
      bytes_(std::exchange(other.bytes_, 0)),
      flags_(other.flags_) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  std::swap(bytes_, other.bytes_);
  std::swap(flags_, other.flags_);
  return *this;
}

void Buffer::requireRange(std::size_t offsetBytes, std::size_t sizeBytes, const char* what) const {
  if (offsetBytes > bytes_ || sizeBytes > bytes_ - offsetBytes)
    throw Failure(fmt::format("buffer \"{}\": {} of {} bytes at {} leaves its {} bytes", label_, what, sizeBytes,
                              offsetBytes, bytes_));
}

void Buffer::upload(std::size_t offsetBytes, std::span<const std::byte> content) {
  requireRange(offsetBytes, content.size(), "upload");
  if (!(flags_ & GL_DYNAMIC_STORAGE_BIT)) throw Failure(fmt::format("buffer \"{}\": made without upload", label_));
  if (content.empty()) return;
  glNamedBufferSubData(id_, static_cast<GLintptr>(offsetBytes), static_cast<GLsizeiptr>(content.size()),
                       content.data());
}

void Buffer::readBytes(std::size_t offsetBytes, std::span<std::byte> content) const {
  requireRange(offsetBytes, content.size(), "read");
  if (content.empty()) return;
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(offsetBytes), static_cast<GLsizeiptr>(content.size()),
                          content.data());
}

void Buffer::clear(std::uint32_t word) {
  // The storage beyond a size that is no multiple of 4 cannot be reached by words; bytes of equal value can.
  if (bytes_ % sizeof(word) == 0) return clear(word, 0, bytes_);
  const auto low = static_cast<std::uint8_t>(word);
  if (word != low * 0x01010101u) throw Failure(fmt::format("buffer \"{}\": {} bytes are no words", label_, bytes_));
  glClearNamedBufferSubData(id_, GL_R8UI, 0, static_cast<GLsizeiptr>(bytes_), GL_RED_INTEGER, GL_UNSIGNED_BYTE, &low);
}

void Buffer::clear(std::uint32_t word, std::size_t offsetBytes, std::size_t sizeBytes) {
  requireRange(offsetBytes, sizeBytes, "clear");
  if (sizeBytes == 0) return;
  glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(offsetBytes), static_cast<GLsizeiptr>(sizeBytes),
                            GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::copyFrom(const Buffer& source, std::size_t sourceOffset, std::size_t offset, std::size_t sizeBytes) {
  source.requireRange(sourceOffset, sizeBytes, "copy");
  requireRange(offset, sizeBytes, "copy");
  if (sizeBytes == 0) return;
  glCopyNamedBufferSubData(source.id_, id_, static_cast<GLintptr>(sourceOffset), static_cast<GLintptr>(offset),
                           static_cast<GLsizeiptr>(sizeBytes));
}

bool Buffer::growTo(std::size_t leastBytes) {
  if (leastBytes <= bytes_) return false;
  Buffer larger(label_, std::max(leastBytes, bytes_ + bytes_ / 2), flags_);
  if (id_) {
    larger.copyFrom(*this, 0, 0, bytes_);
    // NVIDIA 580.159 lets an upload overtake the copy before it, which then puts the old bytes back (seen on an H200: a
    // seventh of the brick indirection lost; neither a barrier nor keeping the old buffer helped). Growth is rare.
    glFinish();
  }
  *this = std::move(larger);
  return true;
}

void Buffer::bindStorage(GLuint index) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, index, id_); }
void Buffer::bindUniform(GLuint index) const { glBindBufferBase(GL_UNIFORM_BUFFER, index, id_); }

void Buffer::bindStorage(GLuint index, std::size_t offsetBytes, std::size_t sizeBytes) const {
  requireRange(offsetBytes, sizeBytes, "binding");
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, index, id_, static_cast<GLintptr>(offsetBytes),
                    static_cast<GLsizeiptr>(sizeBytes));
}
void Buffer::bindUniform(GLuint index, std::size_t offsetBytes, std::size_t sizeBytes) const {
  requireRange(offsetBytes, sizeBytes, "binding");
  glBindBufferRange(GL_UNIFORM_BUFFER, index, id_, static_cast<GLintptr>(offsetBytes),
                    static_cast<GLsizeiptr>(sizeBytes));
}

} // namespace brickfield
