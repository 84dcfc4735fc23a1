// Alpha is coverage: it is kept where the material cuts or blends, and 1 where it is opaque, whatever the texture says.
// Where the mask has cut the geometry itself, the slabs reach beyond the cut: coverage, filtered to a voxel, cuts them
// back to where the mask ends. Colours are read there at half a voxel's width and within the piece: what lies beyond
// the cut, often black, is to stay out of them.
#include "bakers/attribute_baker.h"

#include <algorithm>

#include "bakers/mask_cut.h"
#include "field/brick_field.h"
#include "field/card_crossing.h"

namespace brickfield {

namespace {

constexpr int kPlacesAlongVoxel = 4; // where a mask is looked at: steps of 1/16 of coverage

bool isTextured(const Material& material) {
  return material.baseColorTexture.isUsed() || material.metallicRoughnessTexture.isUsed() ||
         material.occlusionTexture.isUsed() || material.emissionTexture.isUsed();
}

/// Barycentric coordinates (weights of the second and the third corner) of a point's foot on a triangle's plane.
glm::vec2 footOn(const std::array<glm::dvec3, 3>& corners, glm::dvec3 point) {
  const glm::dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = point - corners[0];
  const glm::dvec3 normal = glm::cross(ab, ac); // positive: the triangle has an area
  return glm::vec2(glm::dvec2(glm::dot(glm::cross(ap, ac), normal), glm::dot(glm::cross(ab, ap), normal)) /
                   glm::dot(normal, normal));
}

} // namespace

AttributeBaker::AttributeBaker(const BakeInput& input, const TriangleSoup& soup, bool hasThinCards)
    : input_(&input),
      soup_(&soup),
      sampler_(*input.scene),
      constants_(input.primitives.size()),
      hasThinCards_(hasThinCards) {
  for (std::size_t i = 0; i < input.primitives.size(); ++i) {
    const Primitive& primitive = *input.primitives[i];
    const Material& material = materialOf(*input.scene, primitive);
    hasEmission_ |= material.emission != glm::vec3(0.0f);
    if (!isTextured(material) && primitive.colors.empty()) constants_[i] = sample(material, MaterialPoint{});
    isUniform_ &= constants_[i].has_value() && constants_[i] == constants_[0];
  }
}

PackedAttributes AttributeBaker::at(std::uint32_t triangle, const PointOnTriangle& on, glm::dvec3 sample,
                                    float voxelMetres) const {
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
  packed.baseColor =
      packRgba8(glm::vec4(glm::vec3(unpackRgba8(packed.baseColor)), keptShare(triangle, sample, voxelMetres)));
  if (hasThinCards_ && !isSingleSided(triangle)) {
    const std::uint8_t byte = cardByte(nearestCardAxis(glm::vec3(glm::cross(q - p, r - p))), packed.material >> 31);
    packed.material = (packed.material & 0xffffffu) | std::uint32_t{byte} << 24;
  }
  return packed;
}

/// How much of the voxel's square around a sample's foot the mask keeps: one half at its border. All where it would
/// keep nothing of the material: then it has cut nothing (mask_cut.cpp).
float AttributeBaker::keptShare(std::uint32_t piece, glm::dvec3 sample, float voxelMetres) const {
  const Primitive& primitive = *input_->primitives[soup_->primitiveIndices[piece]];
  const Material& material = materialOf(*input_->scene, primitive);
  const auto& [a, b, c] = soup_->pieceBarycentrics[piece - soup_->firstPiece()];
  const auto isKept = [&, a = a, b = b, c = c](glm::vec2 weights) {
    return isKeptByMask(sampler_, primitive, material, soup_->triangleIndices[piece],
                        a + weights.x * (b - a) + weights.y * (c - a));
  };
  const bool isWhole = a == glm::vec2(0, 0) && b == glm::vec2(1, 0) && c == glm::vec2(0, 1);
  if (isWhole && !isKept(glm::vec2(1.0f / 3.0f))) return 1.0f;
  const auto corners = soup_->corners(piece);
  const glm::dvec3 ab = corners[1] - corners[0];
  // To the outermost of the places, which stand in the middles of equal squares.
  const double far = 0.5 * static_cast<double>(voxelMetres) * soup_->unitsPerMetre * (1.0 - 1.0 / kPlacesAlongVoxel);
  const glm::dvec3 right = far * glm::normalize(ab);
  const glm::dvec3 up = far * glm::normalize(glm::cross(glm::cross(ab, corners[2] - corners[0]), ab));
  const auto isKeptAt = [&](int i, int j) { // from -1 to 1
    const double toRight = static_cast<double>(i) / (kPlacesAlongVoxel - 1),
                 toUp = static_cast<double>(j) / (kPlacesAlongVoxel - 1);
    return isKept(footOn(corners, sample + toRight * right + toUp * up));
  };
  constexpr int kLast = kPlacesAlongVoxel - 1;
  const int atCorners =
      isKeptAt(-kLast, -kLast) + isKeptAt(kLast, -kLast) + isKeptAt(-kLast, kLast) + isKeptAt(kLast, kLast);
  if (const int atFive = atCorners + isKeptAt(0, 0); atFive % 5 == 0) return static_cast<float>(atFive / 5);
  int kept = atCorners;
  for (int j = -kLast; j <= kLast; j += 2)
    for (int i = -kLast; i <= kLast; i += 2)
      if (std::abs(i) < kLast || std::abs(j) < kLast) kept += isKeptAt(i, j);
  return static_cast<float>(kept) / (kPlacesAlongVoxel * kPlacesAlongVoxel);
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
