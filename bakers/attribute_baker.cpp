// Alpha is coverage: it is kept where the material cuts or blends, and 1 where it is opaque, whatever the texture says.
#include "bakers/attribute_baker.h"

#include "field/brick_field.h"

namespace brickfield {

namespace {

bool isTextured(const Material& material) {
  return material.baseColorTexture.isUsed() || material.metallicRoughnessTexture.isUsed() ||
         material.occlusionTexture.isUsed() || material.emissionTexture.isUsed();
}

} // namespace

AttributeBaker::AttributeBaker(const BakeInput& input, const TriangleSoup& soup)
    : input_(&input), soup_(&soup), sampler_(*input.scene), constants_(input.primitives.size()) {
  for (std::size_t i = 0; i < input.primitives.size(); ++i) {
    const Primitive& primitive = *input.primitives[i];
    const Material& material = materialOf(*input.scene, primitive);
    hasEmission_ |= material.emission != glm::vec3(0.0f);
    if (!isTextured(material) && primitive.colors.empty()) constants_[i] = sample(material, MaterialPoint{});
  }
}

PackedAttributes AttributeBaker::at(std::uint32_t triangle, const PointOnTriangle& on, float voxelMetres) const {
  const std::size_t primitiveIndex = soup_->primitiveIndices[triangle];
  if (constants_[primitiveIndex]) return *constants_[primitiveIndex];
  const Primitive& primitive = *input_->primitives[primitiveIndex];
  const std::size_t number = soup_->triangleIndices[triangle];
  MaterialPoint point = materialPointOf(primitive, number, glm::vec2(on.barycentric));
  std::array<glm::vec3, 3> positions;
  for (std::size_t k = 0; k < 3; ++k)
    positions[k] = glm::vec3(soup_->corners(triangle)[k] - soup_->corners(triangle)[0]);
  for (std::size_t set = 0; set < 2; ++set) {
    if (primitive.uvs[set].empty()) continue;
    std::array<glm::vec2, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k) uvs[k] = primitive.uvs[set][primitive.indices[3 * number + k]];
    point.uvPerFootprint[set] =
        uvPerFootprintOf(positions, uvs, voxelMetres * static_cast<float>(soup_->unitsPerMetre));
  }
  return sample(materialOf(*input_->scene, primitive), point);
}

PackedAttributes AttributeBaker::sample(const Material& material, const MaterialPoint& point) const {
  const MaterialSample value = sampler_.sampleMaterial(material, point);
  const float alpha = material.alphaMode == AlphaMode::Opaque ? 1.0f : value.baseColor.w;
  PackedAttributes packed;
  packed.baseColor = packRgba8(glm::vec4(srgbFromLinear(glm::clamp(glm::vec3(value.baseColor), 0.0f, 1.0f)), alpha));
  packed.material = packRgba8({value.metallic, value.roughness, value.occlusion, material.unlit ? 1.0f : 0.0f});
  packed.emission = packRgb9e5(value.emission);
  return packed;
}

} // namespace brickfield
