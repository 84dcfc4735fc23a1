// Cuts alpha-masked sheets (leaf cards, fences) along their masks, so that the field has the leaf's shape, not the
// card's.
#pragma once

#include <vector>

#include "bakers/triangle_soup.h"
#include "scene/texture_sampling.h"

namespace brickfield {

/// Replaces masked triangles by the pieces of them that the mask leaves.
///
/// A triangle is quartered down to pieces of at most half a voxel (coarser where there would be more than four million
/// in all); a piece is kept if the mask keeps its centroid, and four kept quarters are one piece again.
///
/// soup      pieces are added at its end
/// sheets    triangles of the soup
/// voxelSize soup space
/// returns   the unmasked ones of `sheets` and the pieces, ascending; may be empty
/// proved by tests/bake/bakers/mask_cut_test.cpp
std::vector<std::uint32_t> cutMaskedSheets(const BakeInput& input, TriangleSoup& soup,
                                           const std::vector<std::uint32_t>& sheets, double voxelSize);

/// Whether the mask of a triangle's material keeps a point of it. Blended materials are masks at one half, as the
/// opaque frame draws them.
///
/// number       of the triangle in its primitive
/// barycentric  weights of the second and the third corner; beside the triangle its plane goes on
bool isKeptByMask(const TextureSampler& sampler, const Primitive& primitive, const Material& material,
                  std::size_t number, glm::vec2 barycentric);

} // namespace brickfield
