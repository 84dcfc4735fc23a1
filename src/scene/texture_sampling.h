// Textures and materials looked up on the CPU, as a GL sampler would: wrap modes, filters, KHR_texture_transform, sRGB
// decoded before it is filtered, mip levels by footprint. Twin of the material look-up in the geometry pass; used by
// the attribute baker and the reference.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "scene/scene.h"

namespace brickfield {

/// Whether RGB holds sRGB-encoded values (base colour, emission) or plain numbers. Alpha is always plain.
enum class TextureEncoding : std::uint8_t { Linear, Srgb };

/// A place on a primitive as its textures see it.
struct MaterialPoint {
  std::array<glm::vec2, 2> uv{}; ///< TEXCOORD_0 and _1; zero where the primitive has none
  std::array<glm::mat2, 2> uvPerFootprint{
      glm::mat2(0.0f), glm::mat2(0.0f)}; ///< how far uv moves along the two sides
                                         ///< of the footprint (columns); zero: no filtering beyond the magnifying one
  glm::vec4 color{1.0f};                 ///< vertex colour, linear
};

/// What the glTF material says at a point: factors times textures times vertex colour.
struct MaterialSample {
  glm::vec4 baseColor{1.0f}; ///< linear; alpha before any mask
  float metallic = 1.0f;
  float roughness = 1.0f; ///< perceptual
  float occlusion = 1.0f; ///< occlusion strength applied
  glm::vec3 emission{0.0f};
  glm::vec3 normalTangent{0.0f, 0.0f, 1.0f}; ///< unit, normal scale applied
};

/// Vertex attributes at a point of a triangle; footprints stay zero.
///
/// triangle    number of the triangle: vertices indices[3t], [3t+1], [3t+2]
/// barycentric weights of the second and third vertex
MaterialPoint materialPointOf(const Primitive& primitive, std::size_t triangle, glm::vec2 barycentric);

/// How uv moves over a square of the given width that lies in a triangle's plane: the footprint for materialPointOf's
/// point. Zero for triangles without area.
///
/// positions   of the triangle, any space; width is metres of the same space
glm::mat2 uvPerFootprintOf(const std::array<glm::vec3, 3>& positions, const std::array<glm::vec2, 3>& uvs, float width);

/// Looks textures up. Refers to the scene, which must outlive it and stay unchanged; mip levels are made at the first
/// look-up that needs them. Safe to use from any number of threads; the same values on every one.
///
/// proved by tests/unit/scene/texture_sampling_test.cpp
class TextureSampler {
public:
  explicit TextureSampler(const Scene& scene);
  ~TextureSampler();
  TextureSampler(const TextureSampler&) = delete;
  TextureSampler& operator=(const TextureSampler&) = delete;

  /// One texture as its own sampler settings say: the magnifying filter where the footprint spans a texel or less, else
  /// the minifying and mipmap filters at the level of the footprint's longer side (OpenGL 4.5, 8.14).
  ///
  /// texture               -1 or without image: white
  /// uvTexture             after any texture transform
  /// texturePerFootprint   as MaterialPoint's, after any texture transform
  /// returns               linear RGBA in [0,1]
  glm::vec4 sample(int texture, TextureEncoding encoding, glm::vec2 uvTexture,
                   const glm::mat2& texturePerFootprint = glm::mat2(0.0f)) const;

  /// The same through a material's slot: picks the uv set and applies the texture transform. White where unused.
  glm::vec4 sampleSlot(const TextureSlot& slot, TextureEncoding encoding, const MaterialPoint& point) const;

  /// All of a material at a point (glTF 2.0, 3.9).
  MaterialSample sampleMaterial(const Material& material, const MaterialPoint& point) const;

  /// Only base colour and alpha, for masks.
  glm::vec4 sampleBaseColor(const Material& material, const MaterialPoint& point) const;

private:
  struct Pyramid;
  const Pyramid& pyramidOf(int image, TextureEncoding encoding) const;

  const Scene& scene_;
  std::unique_ptr<Pyramid[]> pyramids_; ///< two an image: linear, sRGB
};

} // namespace brickfield
