// Immutable textures and their transfers.
#include "gpu/texture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "gpu/check.h"

namespace brickfield {

namespace {

// Tight transfers to and from memory of ours, whatever a host has set; all is put back at the end of the scope.
class TightTransferScope {
public:
  TightTransferScope() {
    for (std::size_t i = 0; i < kParameters.size(); ++i) {
      glGetIntegerv(kParameters[i], &saved_[i]);
      glPixelStorei(kParameters[i], isAlignment(kParameters[i]) ? 1 : 0);
    }
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpackBuffer_);
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &packBuffer_);
    if (unpackBuffer_) glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    if (packBuffer_) glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  }
  ~TightTransferScope() {
    for (std::size_t i = 0; i < kParameters.size(); ++i) glPixelStorei(kParameters[i], saved_[i]);
    if (unpackBuffer_) glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpackBuffer_));
    if (packBuffer_) glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer_));
  }
  TightTransferScope(const TightTransferScope&) = delete;
  TightTransferScope& operator=(const TightTransferScope&) = delete;

private:
  static bool isAlignment(GLenum parameter) {
    return parameter == GL_UNPACK_ALIGNMENT || parameter == GL_PACK_ALIGNMENT;
  }
  static constexpr std::array<GLenum, 16> kParameters = {
      GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH,  GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_PIXELS,
      GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES,   GL_UNPACK_LSB_FIRST,
      GL_PACK_ALIGNMENT,   GL_PACK_ROW_LENGTH,    GL_PACK_IMAGE_HEIGHT,   GL_PACK_SKIP_PIXELS,
      GL_PACK_SKIP_ROWS,   GL_PACK_SKIP_IMAGES,   GL_PACK_SWAP_BYTES,     GL_PACK_LSB_FIRST};
  std::array<GLint, kParameters.size()> saved_{};
  GLint unpackBuffer_ = 0;
  GLint packBuffer_ = 0;
};

int fullChain(const TextureShape& shape) {
  const int depth = shape.target == GL_TEXTURE_3D ? shape.extent.z : 1;
  const int longest = std::max({shape.extent.x, shape.extent.y, depth});
  return std::bit_width(static_cast<unsigned>(longest));
}

bool hasLayers(GLenum target) { return target != GL_TEXTURE_2D; }
bool isCube(GLenum target) { return target == GL_TEXTURE_CUBE_MAP || target == GL_TEXTURE_CUBE_MAP_ARRAY; }

GLint limitOf(GLenum name) {
  GLint limit = 0;
  glGetIntegerv(name, &limit);
  return limit;
}

std::size_t texelCount(glm::ivec3 extent) {
  return static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y) * static_cast<std::size_t>(extent.z);
}

void requirePossible(const std::string& label, const TextureShape& shape) {
  const bool volume = shape.target == GL_TEXTURE_3D;
  const GLint edge = limitOf(volume                 ? GL_MAX_3D_TEXTURE_SIZE
                             : isCube(shape.target) ? GL_MAX_CUBE_MAP_TEXTURE_SIZE
                                                    : GL_MAX_TEXTURE_SIZE);
  const GLint deep = volume ? edge : limitOf(GL_MAX_ARRAY_TEXTURE_LAYERS);
  const glm::ivec3 e = shape.extent;
  const std::string what = fmt::format("texture \"{}\" of {}x{}x{}", label, e.x, e.y, e.z);
  if (e.x < 1 || e.y < 1 || e.z < 1) throw Failure(what + ": an extent is not positive");
  if (e.x > edge || e.y > edge || e.z > deep)
    throw Failure(fmt::format("{}: the device allows at most {}x{}x{}", what, edge, edge, deep));
  if (shape.levels < 1 || shape.levels > fullChain(shape))
    throw Failure(fmt::format("{}: {} levels", what, shape.levels));
  if (shape.target == GL_TEXTURE_2D && e.z != 1) throw Failure(what + ": a 2D texture has depth 1");
  if (isCube(shape.target) && (e.z % 6 != 0 || e.x != e.y)) throw Failure(what + ": no cube");
}

} // namespace

Texture::Texture(std::string label, const TextureShape& shape) : label_(std::move(label)), shape_(shape) {
  const PixelLayout layout = nativeLayout(shape.format);
  if (shape_.levels == 0) shape_.levels = fullChain(shape_);
  requirePossible(label_, shape_);
  const glm::ivec3 e = shape_.extent;
  glCreateTextures(shape_.target, 1, &id_);
  if (shape_.target == GL_TEXTURE_2D || shape_.target == GL_TEXTURE_CUBE_MAP)
    glTextureStorage2D(id_, shape_.levels, shape_.format, e.x, e.y);
  else
    glTextureStorage3D(id_, shape_.levels, shape_.format, e.x, e.y, e.z);
  const bool nearest = layout.isInteger || layout.isDepth;
  const bool chain = shape_.levels > 1;
  const GLenum minFilter =
      nearest ? (chain ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST) : (chain ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minFilter));
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(id_, axis, GL_CLAMP_TO_EDGE);
  labelObject(GL_TEXTURE, id_, label_);
  try {
    requireNoGlError(fmt::format("texture \"{}\" of {}x{}x{}, {} bytes", label_, e.x, e.y, e.z, bytes()));
  } catch (...) {
    glDeleteTextures(1, &id_);
    throw;
  }
}

Texture Texture::make2D(std::string label, GLenum format, int width, int height, int levels) {
  return Texture(std::move(label), {GL_TEXTURE_2D, format, {width, height, 1}, levels});
}
Texture Texture::make2DArray(std::string label, GLenum format, int width, int height, int layers, int levels) {
  return Texture(std::move(label), {GL_TEXTURE_2D_ARRAY, format, {width, height, layers}, levels});
}
Texture Texture::make3D(std::string label, GLenum format, glm::ivec3 extent, int levels) {
  return Texture(std::move(label), {GL_TEXTURE_3D, format, extent, levels});
}
Texture Texture::makeCube(std::string label, GLenum format, int size, int levels) {
  return Texture(std::move(label), {GL_TEXTURE_CUBE_MAP, format, {size, size, 6}, levels});
}

Texture Texture::viewOf(std::string label, const Texture& texture, GLenum format) {
  Texture view;
  view.label_ = std::move(label);
  view.shape_ = texture.shape_;
  view.shape_.format = format;
  const bool hasSlices = view.shape_.target == GL_TEXTURE_3D;
  glGenTextures(1, &view.id_);
  glTextureView(view.id_, view.shape_.target, texture.id_, format, 0, static_cast<GLuint>(view.shape_.levels), 0,
                hasSlices ? 1u : static_cast<GLuint>(view.shape_.extent.z));
  labelObject(GL_TEXTURE, view.id_, view.label_);
  requireNoGlError(fmt::format("view \"{}\" of texture \"{}\"", view.label_, texture.label_));
  return view;
}

Texture::~Texture() {
  if (id_) glDeleteTextures(1, &id_);
}

Texture::Texture(Texture&& other) noexcept
    : label_(std::move(other.label_)), id_(std::exchange(other.id_, 0)), shape_(other.shape_) {}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  std::swap(shape_, other.shape_);
  return *this;
}

glm::ivec3 Texture::extent(int level) const {
  const glm::ivec3 e = shape_.extent;
  const glm::ivec3 shrunk = glm::max(glm::ivec3(e.x >> level, e.y >> level, e.z >> level), glm::ivec3(1));
  return {shrunk.x, shrunk.y, shape_.target == GL_TEXTURE_3D ? shrunk.z : e.z};
}

std::size_t Texture::bytes() const {
  std::size_t texels = 0;
  for (int level = 0; level < shape_.levels; ++level) texels += texelCount(extent(level));
  return texels * static_cast<std::size_t>(nativeLayout(shape_.format).bytesPerPixel);
}

void Texture::requireBox(int level, glm::ivec3 offset, glm::ivec3 boxExtent, const char* what) const {
  const bool levelExists = level >= 0 && level < shape_.levels;
  const glm::ivec3 whole = levelExists ? extent(level) : glm::ivec3(0);
  const bool inside = levelExists && glm::all(glm::greaterThanEqual(offset, glm::ivec3(0))) &&
                      glm::all(glm::greaterThanEqual(boxExtent, glm::ivec3(0))) &&
                      glm::all(glm::lessThanEqual(offset, whole)) &&
                      glm::all(glm::lessThanEqual(boxExtent, whole - offset));
  if (!inside)
    throw Failure(fmt::format("texture \"{}\": {} of {}x{}x{} at {},{},{} leaves level {} of {}x{}x{}", label_, what,
                              boxExtent.x, boxExtent.y, boxExtent.z, offset.x, offset.y, offset.z, level, whole.x,
                              whole.y, whole.z));
}

void Texture::upload(int level, glm::ivec3 offset, glm::ivec3 boxExtent, std::span<const std::byte> content) {
  upload(level, offset, boxExtent, content, nativeLayout(shape_.format));
}

void Texture::upload(int level, glm::ivec3 offset, glm::ivec3 boxExtent, std::span<const std::byte> content,
                     const PixelLayout& layout) {
  requireBox(level, offset, boxExtent, "upload");
  const std::size_t bytes = texelCount(boxExtent) * static_cast<std::size_t>(layout.bytesPerPixel);
  if (content.size() != bytes)
    throw Failure(fmt::format("texture \"{}\": {} bytes for a box of {}", label_, content.size(), bytes));
  if (bytes == 0) return;
  const TightTransferScope tight;
  const glm::ivec3 o = offset, e = boxExtent;
  if (hasLayers(shape_.target))
    glTextureSubImage3D(id_, level, o.x, o.y, o.z, e.x, e.y, e.z, layout.format, layout.type, content.data());
  else
    glTextureSubImage2D(id_, level, o.x, o.y, e.x, e.y, layout.format, layout.type, content.data());
}

std::size_t Texture::elementCount(glm::ivec3 boxExtent, std::size_t elementBytes) const {
  const auto pixelBytes = static_cast<std::size_t>(nativeLayout(shape_.format).bytesPerPixel);
  const std::size_t bytes = texelCount(glm::max(boxExtent, glm::ivec3(0))) * pixelBytes;
  if (bytes % elementBytes != 0)
    throw Failure(fmt::format("texture \"{}\": {} bytes read as elements of {}", label_, bytes, elementBytes));
  return bytes / elementBytes;
}

void Texture::readBytes(int level, glm::ivec3 offset, glm::ivec3 boxExtent, std::span<std::byte> content,
                        const PixelLayout& layout) const {
  requireBox(level, offset, boxExtent, "read");
  if (content.empty()) return;
  const TightTransferScope tight;
  const glm::ivec3 o = offset, e = boxExtent;
  glGetTextureSubImage(id_, level, o.x, o.y, o.z, e.x, e.y, e.z, layout.format, layout.type,
                       static_cast<GLsizei>(content.size()), content.data());
}

std::vector<float> Texture::readFloats(int level) const {
  PixelLayout layout = nativeLayout(shape_.format);
  if (layout.isInteger || layout.format == GL_DEPTH_STENCIL)
    throw Failure(fmt::format("texture \"{}\": its format has no floats", label_));
  layout.type = GL_FLOAT;
  requireBox(level, glm::ivec3(0), glm::ivec3(0), "read");
  std::vector<float> values(texelCount(extent(level)) * static_cast<std::size_t>(layout.channels));
  readBytes(level, glm::ivec3(0), extent(level), std::as_writable_bytes(std::span(values)), layout);
  return values;
}

void Texture::clearLevel(int level, GLenum format, GLenum type, const void* value) {
  requireBox(level, glm::ivec3(0), glm::ivec3(0), "clear");
  glClearTexImage(id_, level, format, type, value);
}

void Texture::clear(glm::vec4 value, int level) {
  clearLevel(level, nativeLayout(shape_.format).isDepth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, &value);
}
void Texture::clear(glm::uvec4 value, int level) { clearLevel(level, GL_RGBA_INTEGER, GL_UNSIGNED_INT, &value); }
void Texture::clear(glm::ivec4 value, int level) { clearLevel(level, GL_RGBA_INTEGER, GL_INT, &value); }

void Texture::bind(GLuint unit) const { glBindTextureUnit(unit, id_); }

void Texture::bindImage(GLuint unit, int level, GLenum access, GLenum format, int layer) const {
  const bool layered = layer < 0 && hasLayers(shape_.target);
  glBindImageTexture(unit, id_, level, layered ? GL_TRUE : GL_FALSE, std::max(layer, 0), access,
                     format ? format : shape_.format);
}

void Texture::generateMipmaps() { glGenerateTextureMipmap(id_); }

Sampler::Sampler(std::string label, const SamplerOptions& options) : label_(std::move(label)) {
  glCreateSamplers(1, &id_);
  const auto set = [&](GLenum name, GLenum value) { glSamplerParameteri(id_, name, static_cast<GLint>(value)); };
  set(GL_TEXTURE_MIN_FILTER, options.minFilter);
  set(GL_TEXTURE_MAG_FILTER, options.magFilter);
  set(GL_TEXTURE_WRAP_S, options.wrapS);
  set(GL_TEXTURE_WRAP_T, options.wrapT);
  set(GL_TEXTURE_WRAP_R, options.wrapR);
  if (options.compare != GL_NONE) {
    set(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    set(GL_TEXTURE_COMPARE_FUNC, options.compare);
  }
  glSamplerParameterfv(id_, GL_TEXTURE_BORDER_COLOR, &options.border.x);
  // Core only since 4.6; before, an extension that all desktop drivers have.
  if (options.anisotropy > 1 && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
    GLfloat most = 1;
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &most);
    glSamplerParameterf(id_, GL_TEXTURE_MAX_ANISOTROPY, std::min(options.anisotropy, most));
  }
  labelObject(GL_SAMPLER, id_, label_);
}

Sampler::~Sampler() {
  if (id_) glDeleteSamplers(1, &id_);
}
Sampler::Sampler(Sampler&& other) noexcept : label_(std::move(other.label_)), id_(std::exchange(other.id_, 0)) {}
Sampler& Sampler::operator=(Sampler&& other) noexcept {
  std::swap(label_, other.label_);
  std::swap(id_, other.id_);
  return *this;
}
void Sampler::bind(GLuint unit) const { glBindSampler(unit, id_); }
void Sampler::unbind(GLuint unit) { glBindSampler(unit, 0); }

} // namespace brickfield
