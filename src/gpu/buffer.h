// A block of GPU memory with a label. Direct state access only: nothing here changes a binding but the bind functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/gl.h"

namespace brickfield {

/// Immutable storage: its size changes only through growTo, which makes a new one. Move-only; a moved-from buffer is
/// empty (id 0) and may only be assigned or destroyed.
class Buffer {
public:
  Buffer() = default;
  /// bytes  size, may be 0 (then a few bytes are allocated, so that it can be bound); the content is undefined
  /// flags  of glNamedBufferStorage; without GL_DYNAMIC_STORAGE_BIT upload() is not allowed
  /// error  Failure that names the label: out of memory
  Buffer(std::string label, std::size_t bytes, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
  /// With this content.
  template <typename Element>
  Buffer(std::string label, std::span<const Element> elements, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT)
      : Buffer(std::move(label), std::as_bytes(elements), flags) {
    static_assert(std::is_trivially_copyable_v<Element>);
  }
  template <typename Element>
  Buffer(std::string label, const std::vector<Element>& elements, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT)
      : Buffer(std::move(label), std::span<const Element>(elements), flags) {}
  Buffer(std::string label, std::span<const std::byte> content, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  GLuint id() const { return id_; }
  std::size_t bytes() const { return bytes_; }
  const std::string& label() const { return label_; }
  explicit operator bool() const { return id_ != 0; }

  /// Overwrites bytes [offset, offset + size). error Failure if that leaves the buffer
  void upload(std::size_t offsetBytes, std::span<const std::byte> content);
  template <typename Element>
  void upload(std::size_t offsetBytes, std::span<const Element> elements) {
    static_assert(std::is_trivially_copyable_v<Element>);
    upload(offsetBytes, std::as_bytes(elements));
  }
  template <typename Element>
  void upload(std::size_t offsetBytes, const std::vector<Element>& elements) {
    upload(offsetBytes, std::span<const Element>(elements));
  }
  /// One struct at an offset.
  template <typename Value>
  void uploadValue(const Value& value, std::size_t offsetBytes = 0) {
    upload(offsetBytes, std::span<const Value>(&value, 1));
  }

  /// Copies back; waits for the GPU. After shader writes a glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT) is due before.
  /// count  elements, kAll for as many as fit after the offset
  /// error  Failure if that leaves the buffer
  template <typename Element>
  std::vector<Element> read(std::size_t offsetBytes = 0, std::size_t count = kAll) const {
    static_assert(std::is_trivially_copyable_v<Element>);
    if (count == kAll) count = offsetBytes <= bytes_ ? (bytes_ - offsetBytes) / sizeof(Element) : 0;
    std::vector<Element> elements(count);
    readBytes(offsetBytes, std::as_writable_bytes(std::span(elements)));
    return elements;
  }
  template <typename Value>
  Value readValue(std::size_t offsetBytes = 0) const {
    return read<Value>(offsetBytes, 1).front();
  }

  /// Fills the whole buffer with one 32-bit word; with an offset and a size (multiples of 4) a part of it.
  void clear(std::uint32_t word = 0);
  void clear(std::uint32_t word, std::size_t offsetBytes, std::size_t sizeBytes);
  /// GPU-side copy. error Failure if it leaves either buffer
  void copyFrom(const Buffer& source, std::size_t sourceOffset, std::size_t offset, std::size_t sizeBytes);

  /// Makes it at least this large, by half as much again as before or more, keeping the content. The id changes, so
  /// bindings and vertex arrays that name it must be renewed.
  /// returns whether it grew
  bool growTo(std::size_t leastBytes);

  /// Binds the whole buffer, or a part, to an indexed target.
  void bindStorage(GLuint index) const;
  void bindStorage(GLuint index, std::size_t offsetBytes, std::size_t sizeBytes) const;
  void bindUniform(GLuint index) const;
  void bindUniform(GLuint index, std::size_t offsetBytes, std::size_t sizeBytes) const;

  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);

private:
  void readBytes(std::size_t offsetBytes, std::span<std::byte> content) const;
  void requireRange(std::size_t offsetBytes, std::size_t sizeBytes, const char* what) const;

  std::string label_;
  GLuint id_ = 0;
  std::size_t bytes_ = 0;
  GLbitfield flags_ = GL_DYNAMIC_STORAGE_BIT;
};

} // namespace brickfield
