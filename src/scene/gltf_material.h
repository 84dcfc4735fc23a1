// Materials, textures, samplers and the images that they need. Private to the importer.
#pragma once

#include "scene/gltf_document.h"

namespace brickfield {

/// Reads scene.materials and scene.textures. Slots that cannot be served (uv set above 1, image in a format that we
/// do not read) are left out with a warning.
void importMaterials(GltfDocument& document, Scene& scene);

/// Reads scene.images; those that no material slot reaches stay empty and are not opened.
/// error BadInput that names the image: missing, too large, undecodable
void importImages(GltfDocument& document, Scene& scene);

/// Decodes PNG or JPEG to 8-bit RGBA; 16-bit PNG are reduced. The header's size is held against the limits before
/// any pixel is decoded, and no allocation of the decoder may exceed what that size needs.
/// pixelsLeft  of ImportLimits::imagePixelsTotal; taken from
Image decodeImage(const GltfDocument& document, std::span<const std::byte> encoded, const std::string& element,
                  std::uint64_t& pixelsLeft);

} // namespace brickfield
