// glTF materials to rows of shaders/shared/mesh_params.h.
#include "resident/material_table.h"

#include "shared/bindings.h"

namespace brickfield {

namespace {

GLenum wrapMode(Wrap wrap) {
  switch (wrap) {
  case Wrap::Repeat:
    return GL_REPEAT;
  case Wrap::ClampToEdge:
    return GL_CLAMP_TO_EDGE;
  case Wrap::MirroredRepeat:
    return GL_MIRRORED_REPEAT;
  }
  return GL_REPEAT;
}

GLenum minFilter(Filter minify, std::optional<Filter> mipmap) {
  if (!mipmap) return minify == Filter::Nearest ? GL_NEAREST : GL_LINEAR;
  if (minify == Filter::Nearest)
    return *mipmap == Filter::Nearest ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_LINEAR;
  return *mipmap == Filter::Nearest ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR;
}

} // namespace

MaterialTable::MaterialTable(const Scene& scene) : white_(Texture::make2D("white", GL_RGBA8, 1, 1)) {
  white_.clear(glm::vec4(1));
  std::vector<shared::MaterialRow> rows;
  rows.push_back(addMaterial(scene, Material{}));
  for (const Material& material : scene.materials) rows.push_back(addMaterial(scene, material));
  rows_ = Buffer("materials", rows);
}

MaterialTable::Slot MaterialTable::addTexture(const Scene& scene, const TextureSlot& slot, bool srgb) {
  const SceneTexture& texture = scene.textures[static_cast<std::size_t>(slot.texture)];
  Slot result;
  const auto [place, isNew] = textureOfImage_.try_emplace({texture.image, srgb}, static_cast<int>(textures_.size()));
  if (isNew) {
    const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
    const glm::ivec2 size(image.size);
    Texture made = Texture::make2D("material_image_" + std::to_string(texture.image), srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8,
                                   size.x, size.y, 0);
    made.upload(image.rgba);
    made.generateMipmaps();
    textures_.push_back(std::move(made));
  }
  result.texture = place->second;

  // Trilinear only: anisotropic filtering costs llvmpipe 250 times the whole pass.
  SamplerOptions options;
  options.minFilter = minFilter(texture.minify, texture.mipmap);
  options.magFilter = texture.magnify == Filter::Nearest ? GL_NEAREST : GL_LINEAR;
  options.wrapS = wrapMode(texture.wrapU);
  options.wrapT = wrapMode(texture.wrapV);
  const std::array<int, 4> key{static_cast<int>(options.minFilter), static_cast<int>(options.magFilter),
                               static_cast<int>(options.wrapS), static_cast<int>(options.wrapT)};
  const auto [sampler, isNewSampler] = samplerOfOptions_.try_emplace(key, static_cast<int>(samplers_.size()));
  if (isNewSampler) samplers_.emplace_back("material_sampler", options);
  result.sampler = sampler->second;
  return result;
}

shared::MaterialRow MaterialTable::addMaterial(const Scene& scene, const Material& material) {
  const std::array<const TextureSlot*, shared::MATERIAL_TEXTURES> uses{
      &material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
      &material.occlusionTexture, &material.emissionTexture};
  shared::MaterialRow row{};
  row.baseColor = material.baseColor;
  const float cutoff = material.alphaMode == AlphaMode::Opaque ? -1.0f
                       : material.alphaMode == AlphaMode::Mask ? material.alphaCutoff
                                                               : 0.5f;
  row.emission = glm::vec4(material.emission, cutoff);
  row.factors = {material.metallic, material.roughness, material.normalScale, material.occlusionStrength};
  row.flags.x = material.unlit ? 1 : 0;
  row.flags.y = material.doubleSided ? 1 : 0;
  std::array<Slot, shared::MATERIAL_TEXTURES> slots;
  for (std::uint32_t i = 0; i < shared::MATERIAL_TEXTURES; ++i) {
    const TextureSlot& use = *uses[i];
    // Columns to rows: the shader takes dot products with (u, v, 1).
    const glm::mat3 rowsOfTransform = glm::transpose(use.textureFromUv);
    row.textureFromUv[2 * i] = glm::vec4(rowsOfTransform[0], 0.0f);
    row.textureFromUv[2 * i + 1] = glm::vec4(rowsOfTransform[1], 0.0f);
    if (!use.isUsed()) continue;
    slots[i] = addTexture(scene, use, i == shared::MATERIAL_BASE_COLOR || i == shared::MATERIAL_EMISSION);
    row.flags.z |= 1 << i;
    if (use.uvSet == 1) row.flags.w |= 1 << i;
  }
  slots_.push_back(slots);
  doubleSided_.push_back(material.doubleSided);
  masked_.push_back(cutoff >= 0);
  return row;
}

void MaterialTable::bindRows() const { rows_.bindStorage(shared::kMaterialBinding); }

void MaterialTable::bindTextures(int material) const {
  const auto& slots = slots_[static_cast<std::size_t>(rowOf(material))];
  for (std::uint32_t i = 0; i < shared::MATERIAL_TEXTURES; ++i) {
    const GLuint unit = shared::kMaterialTextureUnit + i;
    if (slots[i].texture < 0) {
      white_.bind(unit);
      Sampler::unbind(unit);
    } else {
      textures_[static_cast<std::size_t>(slots[i].texture)].bind(unit);
      samplers_[static_cast<std::size_t>(slots[i].sampler)].bind(unit);
    }
  }
}

std::size_t MaterialTable::bytes() const {
  std::size_t sum = rows_.bytes();
  for (const Texture& texture : textures_) sum += texture.bytes();
  return sum;
}

} // namespace brickfield
