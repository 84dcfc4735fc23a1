// Writing one mesh as a glTF 2.0 binary (.glb): positions, normals, colours, triangles, one material without textures.
// It is no counterpart of the whole importer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace brickfield {

/// A scene of one node of this name with one mesh. Colours are written in 16 bits, opaque.
///
/// primitive  indices, positions and normals, colours if any; the rest is left out
/// material   factors only, emission of any strength (KHR_materials_emissive_strength); textures are left out
/// returns    the bytes of the file, the same for the same input
/// error      BadInput that names the mesh: more than the 4 GiB of a .glb
/// proved by  tests/unit/scene/glb_export_test.cpp, by importing it
std::vector<std::byte> encodeGlb(const std::string& name, const Primitive& primitive, const Material& material);

} // namespace brickfield
