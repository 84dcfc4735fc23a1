// The outermost layer of a glTF file: JSON text alone (.gltf) or the chunks of a binary container (.glb).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brickfield {

/// Views into the file's bytes.
struct GltfContainer {
  std::string_view json;
  std::optional<std::span<const std::byte>> binaryChunk; ///< GLB only; may be longer than buffer 0 by its padding
  bool isBinary = false;
};

/// Tells the two kinds apart by the first four bytes and cuts a GLB into its chunks.
///
/// bytes     the whole file; must outlive the result
/// file      subject of the messages; a name that ends in .glb must be binary
/// warnings  grows by what was skipped: chunks of unknown type, bytes behind the end
/// error     BadInput: header, version, lengths, alignment, order or number of chunks wrong
GltfContainer splitGltfContainer(std::span<const std::byte> bytes, std::string_view file,
                                 std::vector<std::string>& warnings);

} // namespace brickfield
