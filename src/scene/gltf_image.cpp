// Images through stb_image, with sizes and allocations bounded first: a PNG of some kilobytes may claim, or inflate
// to, gigabytes.
#include "scene/gltf_material.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "core/error.h"
#include "scene/gltf_schema.h"
#include "scene/gltf_uri.h"

namespace {

// The most that one allocation of the decoder may have; set for each image by decodeImage.
thread_local std::size_t decoderAllocationLimit = 0;

void* decoderAllocate(std::size_t bytes) { return bytes <= decoderAllocationLimit ? std::malloc(bytes) : nullptr; }
void* decoderReallocate(void* memory, std::size_t bytes) {
  return bytes <= decoderAllocationLimit ? std::realloc(memory, bytes) : nullptr;
}

} // namespace

#define STBI_MALLOC(bytes) decoderAllocate(bytes)
#define STBI_REALLOC(memory, bytes) decoderReallocate(memory, bytes)
#define STBI_FREE(memory) std::free(memory)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace brickfield {

namespace {

using nlohmann::json;

// What can be said without opening anything; unused images have to keep to it as well.
void checkImage(const GltfDocument& document, const json& image, const std::string& element) {
  const bool hasUri = image.contains("uri"), hasView = image.contains("bufferView");
  if (hasUri == hasView)
    document.refuse(element, hasUri ? "has both uri and bufferView" : "has neither uri nor bufferView");
  if (hasUri) return;
  if (!image.contains("mimeType")) document.refuse(element, "lies in a bufferView but has no mimeType");
  const int viewIndex = image["bufferView"].get<int>();
  if (document.model->bufferViews[static_cast<std::size_t>(viewIndex)].byteStride != 0)
    document.refuse(element, fmt::format("bufferView {} has a byteStride", viewIndex));
}

// Bytes of an image as the file stores them; `owned` keeps alive what a uri led to.
std::span<const std::byte> encodedImage(const GltfDocument& document, const json& image, const std::string& element,
                                        std::vector<std::byte>& owned) {
  if (image.contains("uri")) {
    const UriContext context{document.file, element, document.folder, document.limits.fileBytes};
    owned = readUri(image["uri"].get_ref<const std::string&>(), context, {"image/png", "image/jpeg", "image/jpg"});
    return owned;
  }
  const int viewIndex = image["bufferView"].get<int>();
  const tinygltf::BufferView& view = document.model->bufferViews[static_cast<std::size_t>(viewIndex)];
  const auto& buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
  if (!buffer) document.refuse(element, fmt::format("lies in buffer {}, which has no data", view.buffer));
  return buffer->subspan(view.byteOffset, view.byteLength);
}

std::set<int> usedImages(const Scene& scene) {
  std::set<int> used;
  for (const Material& material : scene.materials)
    for (const TextureSlot* slot : {&material.baseColorTexture, &material.metallicRoughnessTexture,
                                    &material.normalTexture, &material.occlusionTexture, &material.emissionTexture})
      if (slot->isUsed()) used.insert(scene.textures[static_cast<std::size_t>(slot->texture)].image);
  return used;
}

} // namespace

Image decodeImage(const GltfDocument& document, std::span<const std::byte> encoded, const std::string& element,
                  std::uint64_t& pixelsLeft) {
  if (encoded.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    document.refuse(element, "is larger than 2 GiB");
  const auto* bytes = reinterpret_cast<const stbi_uc*>(encoded.data());
  const int byteCount = static_cast<int>(encoded.size());
  constexpr std::size_t kHeaderScratch = std::size_t{1} << 20;
  decoderAllocationLimit = kHeaderScratch;
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(bytes, byteCount, &width, &height, &channels))
    document.refuse(element, fmt::format("is neither a PNG nor a JPEG that can be read: {}", stbi_failure_reason()));
  const auto side = static_cast<std::uint32_t>(std::max(width, height));
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (width <= 0 || height <= 0) document.refuse(element, "has no pixels");
  if (side > document.limits.imageSidePixels)
    document.refuse(element, fmt::format("has {} x {} pixels, at most {} a side are read", width, height,
                                         document.limits.imageSidePixels));
  if (pixels > pixelsLeft)
    document.refuse(element,
                    fmt::format("the images have more than {} pixels, the limit", document.limits.imagePixelsTotal));
  pixelsLeft -= pixels;
  // Largest honest block: 16-bit RGBA is 8 bytes a pixel and one a row, inflated into a buffer that doubles. JPEG
  // rounds up to blocks of 32 pixels a side.
  decoderAllocationLimit =
      20 * static_cast<std::size_t>(width + 32) * static_cast<std::size_t>(height + 32) + kHeaderScratch;
  stbi_uc* decoded = stbi_load_from_memory(bytes, byteCount, &width, &height, &channels, 4);
  if (!decoded) document.refuse(element, fmt::format("cannot be decoded: {}", stbi_failure_reason()));
  Image image;
  image.size = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  image.rgba.assign(decoded, decoded + pixels * 4);
  stbi_image_free(decoded);
  return image;
}

void importImages(GltfDocument& document, Scene& scene) {
  if (!document.json.contains("images")) return;
  const json& images = document.json["images"];
  const std::set<int> used = usedImages(scene);
  std::uint64_t pixelsLeft = document.limits.imagePixelsTotal;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string name = images[i].value("name", "");
    const std::string element = elementLabel("image", i, name);
    checkImage(document, images[i], element);
    std::vector<std::byte> owned;
    Image image;
    if (used.contains(static_cast<int>(i)))
      image = decodeImage(document, encodedImage(document, images[i], element, owned), element, pixelsLeft);
    image.name = name;
    scene.images.push_back(std::move(image));
  }
}

} // namespace brickfield
