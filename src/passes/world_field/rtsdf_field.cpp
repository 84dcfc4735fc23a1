// Memory and place of the field.
#include "passes/world_field/rtsdf_field.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr int kMarginTexels = 2; // on each side, so that the surface's texels have neighbours for interpolation

std::size_t texelCount(glm::ivec3 extent) {
  return static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y) * static_cast<std::size_t>(extent.z);
}

RtsdfSettings checked(const RtsdfSettings& settings) {
  checkRtsdfSettings(settings);
  return settings;
}

/// Drivers cut longer bindings short in silence.
void requireOneBinding(std::size_t bytes) {
  GLint64 most = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (bytes > static_cast<std::uint64_t>(most))
    throw BadInput("rtsdf", "size",
                   fmt::format("needs buffers of {} bytes, this driver's shaders reach {}", bytes, most));
}

} // namespace

RtsdfField::RtsdfField(const RtsdfSettings& settings) : settings_(checked(settings)), extent_(rtsdfExtent(settings)) {
  const std::size_t words = texelCount(extent_) * sizeof(float);
  requireOneBinding(words);
  shortest_ = Buffer("rtsdf_shortest", words, 0);
  votes_ = Buffer("rtsdf_votes", words, 0);
  volume_ = Texture::make3D("world_field_rtsdf", GL_R16F, extent_);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(volume_.id(), wrap, GL_REPEAT);
  // The brute force has no coarse field; one texel keeps its programs' bindings whole.
  const glm::ivec3 coarseExtent(settings_.bruteForce ? 1 : settings_.coarseSize);
  requireOneBinding(texelCount(coarseExtent) * sizeof(std::uint32_t));
  for (Buffer& half : seeds_) half = Buffer("rtsdf_seeds", texelCount(coarseExtent) * sizeof(std::uint32_t), 0);
  coarse_ = Texture::make3D("world_field_coarse", GL_R32F, coarseExtent);
  largeTriangles_ = Buffer("rtsdf_large_triangles", sizeof(std::uint32_t));
  place({});
}

void RtsdfField::place(const Box& boundsAnchored) {
  const glm::vec3 extentMetres = boundsAnchored.extent();
  float texelSize = 0;
  for (int axis = 0; axis < 3; ++axis)
    texelSize = std::max(texelSize, extentMetres[axis] / static_cast<float>(extent_[axis] - 2 * kMarginTexels - 1));
  // The lattice goes through the anchor: rounding the window to it moves it by half a texel at most, which is the
  // texel that is missing above. A scene without extent gets one of a metre.
  if (!(texelSize > 0) || !std::isfinite(texelSize)) texelSize = 1.0f / static_cast<float>(extent_.x);
  const glm::vec3 center = boundsAnchored.isEmpty() ? glm::vec3(0) : boundsAnchored.center();
  // Far from the anchor floats have no finer places, and lattice numbers must stay integers.
  const glm::vec3 far = glm::abs(center);
  texelSize = std::max(texelSize, std::max({far.x, far.y, far.z}) * 0x1p-22f);
  const glm::ivec3 first = glm::ivec3(glm::round(center / texelSize)) - extent_ / 2;
  const int longest = std::max({extent_.x, extent_.y, extent_.z});
  shared::FieldCascade cascade{};
  cascade.window = {first, longest};
  // No distance in the box is longer than its diagonal; rays leave the box, where no reader is.
  cascade.texel = {texelSize, 1.0f / texelSize, glm::length(glm::vec3(extent_)), 0.0f};
  cascade.buffers = {0, 0, 0, shared::FIELD_WHOLE};
  cascade.extent = glm::vec4(extent_, 0);
  if (cascade.window != cascade_.window || cascade.texel != cascade_.texel) restart();
  cascade_ = cascade;
}

std::size_t RtsdfField::bytes() const {
  return seeds_[0].bytes() + seeds_[1].bytes() + largeTriangles_.bytes() + shortest_.bytes() + votes_.bytes() +
         coarse_.bytes() + volume_.bytes();
}

void RtsdfField::reserveTriangles(std::uint32_t count) {
  largeTriangles_.growTo((std::size_t{count} + 1) * sizeof(std::uint32_t));
}

std::vector<float> RtsdfField::readDistances() const {
  std::vector<float> distances = shortest_.read<float>();
  if (!settings_.signByVote) return distances;
  const std::vector<float> votes = votes_.read<float>();
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (votes[i] < 0) distances[i] = -std::abs(distances[i]);
  return distances;
}

} // namespace brickfield
