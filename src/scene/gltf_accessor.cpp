// Range proofs are done in 64 bits with every operand bounded first, so that nothing can wrap.
#include "scene/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_schema.h"

namespace brickfield {

namespace {

using tinygltf::Accessor;
using tinygltf::BufferView;

// Elements that an accessor without a view may have: they cost a file nothing. 2^24 is the vertex count at which
// meshes are split into several by every tool that we know.
constexpr std::uint64_t kMostUnbackedElements = std::uint64_t{1} << 24;

std::uint64_t componentBytes(int componentType) {
  switch (componentType) {
  case TINYGLTF_COMPONENT_TYPE_BYTE:
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return 1;
  case TINYGLTF_COMPONENT_TYPE_SHORT:
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return 2;
  default:
    return 4;
  }
}

std::string_view componentName(int componentType) {
  switch (componentType) {
  case TINYGLTF_COMPONENT_TYPE_BYTE:
    return "i8";
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return "u8";
  case TINYGLTF_COMPONENT_TYPE_SHORT:
    return "i16";
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return "u16";
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    return "u32";
  default:
    return "f32";
  }
}

std::string_view typeName(int type) {
  switch (type) {
  case TINYGLTF_TYPE_SCALAR:
    return "SCALAR";
  case TINYGLTF_TYPE_VEC2:
    return "VEC2";
  case TINYGLTF_TYPE_VEC3:
    return "VEC3";
  case TINYGLTF_TYPE_VEC4:
    return "VEC4";
  case TINYGLTF_TYPE_MAT2:
    return "MAT2";
  case TINYGLTF_TYPE_MAT3:
    return "MAT3";
  default:
    return "MAT4";
  }
}

// How an element lies in memory: columns of `rows` components; matrix columns start at multiples of four bytes.
struct Layout {
  int columns = 1;
  int rows = 1;
  std::uint64_t component = 4;
  std::uint64_t column = 4;
  std::uint64_t element = 4; // bytes from one packed element to the next
  std::uint64_t extent = 4;  // bytes from the first to behind the last component
};

Layout layoutOf(int type, int componentType) {
  Layout layout;
  switch (type) {
  case TINYGLTF_TYPE_SCALAR:
    break;
  case TINYGLTF_TYPE_VEC2:
    layout.rows = 2;
    break;
  case TINYGLTF_TYPE_VEC3:
    layout.rows = 3;
    break;
  case TINYGLTF_TYPE_VEC4:
    layout.rows = 4;
    break;
  case TINYGLTF_TYPE_MAT2:
    layout.rows = layout.columns = 2;
    break;
  case TINYGLTF_TYPE_MAT3:
    layout.rows = layout.columns = 3;
    break;
  default:
    layout.rows = layout.columns = 4;
    break;
  }
  layout.component = componentBytes(componentType);
  layout.column = layout.component * static_cast<std::uint64_t>(layout.rows);
  if (layout.columns > 1) layout.column = (layout.column + 3) / 4 * 4;
  layout.element = layout.column * static_cast<std::uint64_t>(layout.columns);
  layout.extent = layout.column * static_cast<std::uint64_t>(layout.columns - 1) +
                  layout.component * static_cast<std::uint64_t>(layout.rows);
  return layout;
}

std::string labelOf(const GltfDocument& document, int accessor) {
  return elementLabel("accessor", static_cast<std::size_t>(accessor),
                      document.model->accessors[static_cast<std::size_t>(accessor)].name);
}

const Accessor& accessorAt(const GltfDocument& document, int accessor) {
  return document.model->accessors[static_cast<std::size_t>(accessor)];
}

void checkViews(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.model->bufferViews.size(); ++i) {
    const BufferView& view = document.model->bufferViews[i];
    const std::string element = elementLabel("bufferView", i, view.name);
    const std::uint64_t bufferBytes = document.bufferBytes[static_cast<std::size_t>(view.buffer)];
    if (view.byteOffset > bufferBytes || view.byteLength > bufferBytes - view.byteOffset)
      document.refuse(element, fmt::format("bytes {} to {} lie outside of buffer {} of {} bytes", view.byteOffset,
                                           view.byteOffset + view.byteLength, view.buffer, bufferBytes));
    if (view.byteStride % 4 != 0)
      document.refuse(element, fmt::format("byteStride {} is not a multiple of 4", view.byteStride));
    if (view.byteStride > view.byteLength)
      document.refuse(element, fmt::format("byteStride {} is above byteLength {}", view.byteStride, view.byteLength));
    if (view.byteStride != 0 && view.target == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER)
      document.refuse(element, "holds indices, which may have no byteStride");
  }
}

// count elements of `layout` at byteOffset with the view's stride lie in the view and are aligned.
void checkRange(const GltfDocument& document, const std::string& element, int viewIndex, std::uint64_t byteOffset,
                std::uint64_t count, const Layout& layout) {
  const BufferView& view = document.model->bufferViews[static_cast<std::size_t>(viewIndex)];
  const std::uint64_t stride = view.byteStride ? view.byteStride : layout.element;
  if (stride < layout.extent)
    document.refuse(element, fmt::format("elements of {} bytes do not fit byteStride {} of bufferView {}",
                                         layout.element, stride, viewIndex));
  if (byteOffset % layout.component != 0 || (byteOffset + view.byteOffset) % layout.component != 0)
    document.refuse(element, fmt::format("does not start at a multiple of its component's {} bytes", layout.component));
  if (layout.columns > 1 && byteOffset % 4 != 0)
    document.refuse(element, "its matrices do not start at a multiple of 4 bytes");
  // count < 2^32, stride <= 252, byteOffset <= 2^53: no sum below can wrap.
  const std::uint64_t end = byteOffset + stride * (count - 1) + layout.extent;
  if (end > view.byteLength)
    document.refuse(element, fmt::format("needs {} bytes, bufferView {} has {}", end, viewIndex, view.byteLength));
}

void checkSparse(const GltfDocument& document, const std::string& element, const Accessor& accessor) {
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<std::uint64_t>(sparse.count);
  if (count > accessor.count)
    document.refuse(element, fmt::format("has {} sparse values for {} elements", count, accessor.count));
  for (const int view : {sparse.indices.bufferView, sparse.values.bufferView})
    if (document.model->bufferViews[static_cast<std::size_t>(view)].byteStride != 0)
      document.refuse(element, fmt::format("its sparse bufferView {} has a byteStride", view));
  checkRange(document, element + " sparse indices", sparse.indices.bufferView,
             static_cast<std::uint64_t>(sparse.indices.byteOffset), count,
             layoutOf(TINYGLTF_TYPE_SCALAR, sparse.indices.componentType));
  checkRange(document, element + " sparse values", sparse.values.bufferView,
             static_cast<std::uint64_t>(sparse.values.byteOffset), count,
             layoutOf(accessor.type, accessor.componentType));
}

template <typename Raw>
Raw load(const std::byte* source) {
  Raw raw;
  std::memcpy(&raw, source, sizeof raw);
  return raw;
}

double loadNumber(const std::byte* source, int componentType, bool normalized) {
  switch (componentType) {
  case TINYGLTF_COMPONENT_TYPE_BYTE: {
    const double value = load<std::int8_t>(source);
    return normalized ? std::max(value / 127.0, -1.0) : value;
  }
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    return load<std::uint8_t>(source) / (normalized ? 255.0 : 1.0);
  case TINYGLTF_COMPONENT_TYPE_SHORT: {
    const double value = load<std::int16_t>(source);
    return normalized ? std::max(value / 32767.0, -1.0) : value;
  }
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    return load<std::uint16_t>(source) / (normalized ? 65535.0 : 1.0);
  case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    return load<std::uint32_t>(source);
  default:
    return static_cast<double>(load<float>(source));
  }
}

const std::byte* viewStart(const GltfDocument& document, const std::string& element, int viewIndex) {
  const BufferView& view = document.model->bufferViews[static_cast<std::size_t>(viewIndex)];
  const auto& buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
  if (!buffer) document.refuse(element, fmt::format("lies in buffer {}, which has no data", view.buffer));
  return buffer->data() + view.byteOffset;
}

template <typename Number>
void readElements(const std::byte* source, std::uint64_t stride, std::uint64_t count, const Accessor& accessor,
                  const Layout& layout, Number* destination) {
  for (std::uint64_t i = 0; i < count; ++i)
    for (int column = 0; column < layout.columns; ++column)
      for (int row = 0; row < layout.rows; ++row)
        *destination++ =
            static_cast<Number>(loadNumber(source + i * stride + static_cast<std::uint64_t>(column) * layout.column +
                                               static_cast<std::uint64_t>(row) * layout.component,
                                           accessor.componentType, accessor.normalized));
}

template <typename Number>
std::vector<Number> readAll(const GltfDocument& document, int index) {
  const Accessor& accessor = accessorAt(document, index);
  const std::string element = labelOf(document, index);
  const Layout layout = layoutOf(accessor.type, accessor.componentType);
  const auto width = static_cast<std::size_t>(layout.columns * layout.rows);
  if (accessor.bufferView < 0 && accessor.count > kMostUnbackedElements)
    document.refuse(element, fmt::format("{} elements without a bufferView, at most {} are read", accessor.count,
                                         kMostUnbackedElements));
  std::vector<Number> numbers(accessor.count * width, Number(0));
  if (accessor.bufferView >= 0) {
    const BufferView& view = document.model->bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    readElements(viewStart(document, element, accessor.bufferView) + accessor.byteOffset,
                 view.byteStride ? view.byteStride : layout.element, accessor.count, accessor, layout, numbers.data());
  }
  if (!accessor.sparse.isSparse) return numbers;
  const auto& sparse = accessor.sparse;
  const std::byte* indices = viewStart(document, element, sparse.indices.bufferView) + sparse.indices.byteOffset;
  const std::byte* values = viewStart(document, element, sparse.values.bufferView) + sparse.values.byteOffset;
  const std::uint64_t indexBytes = componentBytes(sparse.indices.componentType);
  std::int64_t previous = -1;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(sparse.count); ++i) {
    const auto target =
        static_cast<std::int64_t>(loadNumber(indices + i * indexBytes, sparse.indices.componentType, false));
    if (target <= previous) document.refuse(element, fmt::format("sparse index {} at {} does not increase", target, i));
    if (static_cast<std::uint64_t>(target) >= accessor.count)
      document.refuse(element, fmt::format("sparse index {} at {} is not below count {}", target, i, accessor.count));
    previous = target;
    readElements(values + i * layout.element, layout.element, 1, accessor, layout,
                 numbers.data() + static_cast<std::size_t>(target) * width);
  }
  return numbers;
}

} // namespace

void checkAccessors(const GltfDocument& document) {
  checkViews(document);
  for (std::size_t i = 0; i < document.model->accessors.size(); ++i) {
    const Accessor& accessor = document.model->accessors[i];
    const std::string element = elementLabel("accessor", i, accessor.name);
    const bool isFloatOrU32 = componentBytes(accessor.componentType) == 4;
    if (accessor.normalized && isFloatOrU32) document.refuse(element, "f32 and u32 cannot be normalized");
    if (accessor.bufferView >= 0)
      checkRange(document, element, accessor.bufferView, accessor.byteOffset, accessor.count,
                 layoutOf(accessor.type, accessor.componentType));
    else if (document.json["accessors"][i].contains("byteOffset"))
      document.refuse(element, "has a byteOffset but no bufferView");
    if (accessor.sparse.isSparse) checkSparse(document, element, accessor);
  }
}

std::uint64_t accessorCount(const GltfDocument& document, int accessor) { return accessorAt(document, accessor).count; }

int accessorComponents(const GltfDocument& document, int accessor) {
  const Layout layout = layoutOf(accessorAt(document, accessor).type, TINYGLTF_COMPONENT_TYPE_FLOAT);
  return layout.columns * layout.rows;
}

bool accessorIsEmpty(const GltfDocument& document, int accessor) {
  return accessorAt(document, accessor).bufferView < 0 && !accessorAt(document, accessor).sparse.isSparse;
}

void checkFormat(const GltfDocument& document, int index, const AccessorFormat& format, const std::string& user) {
  const Accessor& accessor = accessorAt(document, index);
  const std::string type(typeName(accessor.type));
  if (("|" + format.types + "|").find("|" + type + "|") == std::string::npos)
    document.refuse(user, fmt::format("{} is {}, not {}", labelOf(document, index), type, format.types));
  const std::string component = std::string(componentName(accessor.componentType)) + (accessor.normalized ? "n" : "");
  std::istringstream known(format.components);
  bool isKnown = false;
  for (std::string word; known >> word;) isKnown |= word == component;
  if (!isKnown)
    document.refuse(user, fmt::format("{} has components {}, not one of {}", labelOf(document, index), component,
                                      format.components));
  if (!format.mayStride && accessor.bufferView >= 0 &&
      document.model->bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride != 0)
    document.refuse(user, fmt::format("{} lies in a bufferView with a byteStride", labelOf(document, index)));
}

std::vector<float> readFloats(const GltfDocument& document, int accessor) {
  std::vector<float> numbers = readAll<float>(document, accessor);
  const auto bad = std::find_if(numbers.begin(), numbers.end(), [](float number) { return !std::isfinite(number); });
  if (bad != numbers.end())
    document.refuse(
        labelOf(document, accessor),
        fmt::format("element {} holds {}", (bad - numbers.begin()) / accessorComponents(document, accessor), *bad));
  return numbers;
}

std::vector<std::uint32_t> readIntegers(const GltfDocument& document, int accessor) {
  return readAll<std::uint32_t>(document, accessor);
}

} // namespace brickfield
