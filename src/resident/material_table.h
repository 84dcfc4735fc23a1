// Materials and their textures on the GPU. An image that serves a colour slot and a data slot exists twice, as sRGB and
// as linear, because the decoding belongs to the texture.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "scene/scene.h"
#include "shared/mesh_params.h"

namespace brickfield {

class MaterialTable {
public:
  /// Uploads all materials, and the textures that they use, with mips. Row 0 is the glTF default material; the scene's
  /// material m is row m + 1.
  explicit MaterialTable(const Scene& scene);

  static int rowOf(int material) { return material + 1; }
  bool isDoubleSided(int material) const { return doubleSided_[static_cast<std::size_t>(rowOf(material))]; }
  /// Whether its alpha cuts parts away.
  bool isMasked(int material) const { return masked_[static_cast<std::size_t>(rowOf(material))]; }

  void bindRows() const;
  /// Textures and samplers of one material to the five units from kMaterialTextureUnit on.
  void bindTextures(int material) const;
  std::size_t bytes() const;

private:
  struct Slot {
    int texture = -1; // into textures_
    int sampler = -1; // into samplers_
  };
  shared::MaterialRow addMaterial(const Scene& scene, const Material& material);
  Slot addTexture(const Scene& scene, const TextureSlot& slot, bool srgb);

  std::vector<Texture> textures_;
  std::vector<Sampler> samplers_;
  std::map<std::pair<int, bool>, int> textureOfImage_;
  std::map<std::array<int, 4>, int> samplerOfOptions_;
  std::vector<std::array<Slot, shared::MATERIAL_TEXTURES>> slots_; // a row each
  std::vector<bool> doubleSided_, masked_;
  Texture white_;
  Buffer rows_;
};

} // namespace brickfield
