// Textures and samplers with labels, by direct state access. Pixel transfers are tight (alignment 1) whatever the pixel
// store state of the host is, and leave that state as found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/gl.h"

namespace brickfield {

/// How pixels of an internal format lie in memory when they are uploaded or read without conversion.
struct PixelLayout {
  GLenum format = 0;
  GLenum type = 0;
  int channels = 0;
  int bytesPerPixel = 0;
  bool isInteger = false;
  bool isDepth = false;
};
/// error Failure for an internal format that this room does not know
PixelLayout nativeLayout(GLenum internalFormat);

struct TextureShape {
  GLenum target = GL_TEXTURE_2D; ///< GL_TEXTURE_2D, _2D_ARRAY, _3D, _CUBE_MAP, _CUBE_MAP_ARRAY
  GLenum format = GL_RGBA8;      ///< sized internal format
  glm::ivec3 extent{1};          ///< width, height, and depth or layers (6 a cube)
  int levels = 1;                ///< 0 asks for the whole chain
};

/// Immutable storage. Without a sampler it filters linearly (integer and depth formats: nearest), clamped to its edge.
/// Move-only; a moved-from texture has id 0.
class Texture {
public:
  Texture() = default;
  /// error Failure that names the label: beyond the device's limits or its memory
  Texture(std::string label, const TextureShape& shape);
  static Texture make2D(std::string label, GLenum format, int width, int height, int levels = 1);
  static Texture make2DArray(std::string label, GLenum format, int width, int height, int layers, int levels = 1);
  static Texture make3D(std::string label, GLenum format, glm::ivec3 extent, int levels = 1);
  static Texture makeCube(std::string label, GLenum format, int size, int levels = 1);
  /// The same texels in another format of the same size; the other texture must outlive what is drawn through it.
  static Texture viewOf(std::string label, const Texture& texture, GLenum format);
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  GLuint id() const { return id_; }
  const std::string& label() const { return label_; }
  GLenum format() const { return shape_.format; }
  GLenum target() const { return shape_.target; }
  int width() const { return shape_.extent.x; }
  int height() const { return shape_.extent.y; }
  int depth() const { return shape_.extent.z; }
  int levels() const { return shape_.levels; }
  explicit operator bool() const { return id_ != 0; }
  /// Extent of a level; layers do not shrink, depth does.
  glm::ivec3 extent(int level = 0) const;
  /// Of all levels, as stored without the driver's padding.
  std::size_t bytes() const;

  /// Writes a box of texels, x fastest, in the native layout of the format or in another one.
  /// error Failure if the box leaves the level or the content is not exactly as large as the box
  void upload(int level, glm::ivec3 offset, glm::ivec3 extent, std::span<const std::byte> content);
  void upload(int level, glm::ivec3 offset, glm::ivec3 extent, std::span<const std::byte> content,
              const PixelLayout& layout);
  template <typename Element>
  void upload(int level, glm::ivec3 offset, glm::ivec3 boxExtent, const std::vector<Element>& content) {
    static_assert(std::is_trivially_copyable_v<Element>);
    upload(level, offset, boxExtent, std::as_bytes(std::span(content)));
  }
  /// A whole level.
  template <typename Element>
  void upload(const std::vector<Element>& content, int level = 0) {
    upload(level, glm::ivec3(0), extent(level), content);
  }

  /// A whole level, or a box of it, in the native layout; waits for the GPU. After image stores a
  /// glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT) is due before.
  /// error Failure if elements do not divide the bytes
  template <typename Element>
  std::vector<Element> read(int level = 0) const {
    return read<Element>(level, glm::ivec3(0), extent(level));
  }
  template <typename Element>
  std::vector<Element> read(int level, glm::ivec3 offset, glm::ivec3 boxExtent) const {
    static_assert(std::is_trivially_copyable_v<Element>);
    std::vector<Element> elements(elementCount(boxExtent, sizeof(Element)));
    readBytes(level, offset, boxExtent, std::as_writable_bytes(std::span(elements)), nativeLayout(shape_.format));
    return elements;
  }
  /// A whole level converted to floats, as many as the format has channels each texel. Not for integer formats.
  std::vector<float> readFloats(int level = 0) const;

  /// Fills a level; the kind of value must be that of the format (float, normalized and depth; unsigned; signed).
  void clear(glm::vec4 value, int level = 0);
  void clear(glm::uvec4 value, int level = 0);
  void clear(glm::ivec4 value, int level = 0);

  void bind(GLuint unit) const;
  /// access  GL_READ_ONLY, GL_WRITE_ONLY, GL_READ_WRITE
  /// format  0 for the texture's own, else a compatible one (GL_R32UI for a GL_R32F texture)
  /// layer   -1 binds all layers
  void bindImage(GLuint unit, int level, GLenum access, GLenum format = 0, int layer = -1) const;
  void generateMipmaps();

private:
  std::size_t elementCount(glm::ivec3 boxExtent, std::size_t elementBytes) const;
  void requireBox(int level, glm::ivec3 offset, glm::ivec3 boxExtent, const char* what) const;
  void readBytes(int level, glm::ivec3 offset, glm::ivec3 boxExtent, std::span<std::byte> content,
                 const PixelLayout& layout) const;
  void clearLevel(int level, GLenum format, GLenum type, const void* value);

  std::string label_;
  GLuint id_ = 0;
  TextureShape shape_;
};

struct SamplerOptions {
  GLenum minFilter = GL_LINEAR;
  GLenum magFilter = GL_LINEAR;
  GLenum wrapS = GL_CLAMP_TO_EDGE;
  GLenum wrapT = GL_CLAMP_TO_EDGE;
  GLenum wrapR = GL_CLAMP_TO_EDGE;
  GLenum compare = GL_NONE; ///< GL_GREATER and the like make it a shadow sampler
  float anisotropy = 1;     ///< clamped to what the device has
  glm::vec4 border{0};      ///< for GL_CLAMP_TO_BORDER
};

class Sampler {
public:
  Sampler() = default;
  Sampler(std::string label, const SamplerOptions& options);
  ~Sampler();
  Sampler(Sampler&& other) noexcept;
  Sampler& operator=(Sampler&& other) noexcept;

  GLuint id() const { return id_; }
  void bind(GLuint unit) const;
  /// Takes whatever sampler is bound off the unit, so that the texture's own filter counts.
  static void unbind(GLuint unit);

private:
  std::string label_;
  GLuint id_ = 0;
};

} // namespace brickfield
