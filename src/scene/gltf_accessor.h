// Accessors as plain numbers: ranges, strides and alignment proved before a byte is read, sparse values applied,
// normalized integers decoded. Private to the importer.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf_document.h"

namespace brickfield {

/// Proves that every view lies in its buffer and every accessor in its view, sparse parts included. cost no data read
void checkAccessors(const GltfDocument& document);

/// What a reader expects of an accessor; anything else is BadInput.
struct AccessorFormat {
  /// A glTF type, or two: "VEC3|VEC4".
  std::string types;
  /// Component types: "f32 u8n u16n"; n = normalized, plain = not.
  std::string components;
  bool mayStride = true; ///< only vertex attributes may have views with a byteStride
};

std::uint64_t accessorCount(const GltfDocument& document, int accessor);
/// Numbers in an element: 1 for SCALAR to 16 for MAT4.
int accessorComponents(const GltfDocument& document, int accessor);
/// Neither a view nor sparse values: the numbers come from elsewhere, or nowhere.
bool accessorIsEmpty(const GltfDocument& document, int accessor);

/// Throws where the accessor is not what the user of it needs.
///
/// user  who needs it: `mesh 0 primitive 1: POSITION`
void checkFormat(const GltfDocument& document, int accessor, const AccessorFormat& format, const std::string& user);

/// All elements, one after the other, matrices by columns without padding.
///
/// error     BadInput that names the accessor: a value that is not finite
/// bound     the caller has spent accessorCount from the limits
std::vector<float> readFloats(const GltfDocument& document, int accessor);

/// The same for unsigned integers that are not normalized.
std::vector<std::uint32_t> readIntegers(const GltfDocument& document, int accessor);

} // namespace brickfield
