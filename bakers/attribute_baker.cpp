// Alpha is coverage: it is kept where the material cuts or blends, and 1 where it is opaque, whatever the texture says,
// and where the mask has cut the geometry itself. There textures are read at half a voxel's width: what lies beyond the
// cut, often black, is to stay out of the colour.
#include "bakers/attribute_baker.h"

#include <algorithm>

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
    isUniform_ &= constants_[i].has_value() && constants_[i] == constants_[0];
  }
}

PackedAttributes AttributeBaker::at(std::uint32_t triangle, const PointOnTriangle& on, float voxelMetres) const {
  const std::size_t firstPiece = soup_->firstPiece();
  if (triangle < firstPiece) return atParent(triangle, glm::vec2(on.barycentric), voxelMetres);
  // A piece's rim may lie beyond the cut, by a part of the smallest piece: the point is drawn towards the centroid, by
  // about half a voxel, and for small pieces all the way.
  const auto [p, q, r] = soup_->corners(triangle);
  const auto edgeMetres =
      static_cast<float>(std::max({glm::length(q - p), glm::length(r - q), glm::length(p - r)}) / soup_->unitsPerMetre);
  const float share = std::max(0.0f, 1.0f - voxelMetres / edgeMetres);
  const glm::vec2 weights = glm::mix(glm::vec2(1.0f / 3.0f), glm::vec2(on.barycentric), share);
  const auto& [a, b, c] = soup_->pieceBarycentrics[triangle - firstPiece];
  PackedAttributes packed =
      atParent(triangle, a + weights.x * (b - a) + weights.y * (c - a), share > 0.0f ? 0.5f * voxelMetres : 0.0f);
  packed.baseColor = packRgba8(glm::vec4(glm::vec3(unpackRgba8(packed.baseColor)), 1.0f));
  return packed;
}

bool AttributeBaker::isSingleSided(std::uint32_t triangle) const {
  if (!soup_->isBackCovered.empty() && soup_->isBackCovered[triangle]) return false;
  return !materialOf(*input_->scene, *input_->primitives[soup_->primitiveIndices[triangle]]).doubleSided;
}

PackedAttributes AttributeBaker::atParent(std::uint32_t triangle, glm::vec2 barycentric, float footprintMetres) const {
  const std::size_t primitiveIndex = soup_->primitiveIndices[triangle], number = soup_->triangleIndices[triangle];
  if (constants_[primitiveIndex]) return *constants_[primitiveIndex];
  const Primitive& primitive = *input_->primitives[primitiveIndex];
  MaterialPoint point = materialPointOf(primitive, number, barycentric);
  std::array<std::uint32_t, 3> vertices;
  std::array<glm::vec3, 3> positions;
  for (std::size_t k = 0; k < 3; ++k) {
    vertices[k] = primitive.indices[3 * number + k];
    positions[k] = input_->positionsObject[primitiveIndex][vertices[k]];
  }
  for (std::size_t set = 0; set < 2; ++set) {
    const std::vector<glm::vec2>& uvs = primitive.uvs[set];
    if (uvs.empty()) continue;
    point.uvPerFootprint[set] =
        uvPerFootprintOf(positions, {uvs[vertices[0]], uvs[vertices[1]], uvs[vertices[2]]}, footprintMetres);
  }
  return sample(materialOf(*input_->scene, primitive), point);
}

PackedAttributes AttributeBaker::sample(const Material& material, const MaterialPoint& point) const {
  const MaterialSample value = sampler_.sampleMaterial(material, point);
  // Coverage of one half is where the material cuts, whatever its cutoff.
  const float halved = material.alphaMode == AlphaMode::Mask && material.alphaCutoff > 0.0f
                           ? std::min(1.0f, 0.5f * value.baseColor.w / material.alphaCutoff)
                           : value.baseColor.w;
  const float alpha = material.alphaMode == AlphaMode::Opaque ? 1.0f : halved;
  PackedAttributes packed;
  packed.baseColor = packRgba8(glm::vec4(srgbFromLinear(glm::clamp(glm::vec3(value.baseColor), 0.0f, 1.0f)), alpha));
  packed.material = packRgba8({value.metallic, value.roughness, value.occlusion, material.unlit ? 1.0f : 0.0f});
  packed.emission = packRgb9e5(value.emission);
  return packed;
}

} // namespace brickfield
