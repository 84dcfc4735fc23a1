// Texture and material look-ups on the CPU. Filtering follows OpenGL 4.5, 8.14-8.15; the mip levels are boxes of exact
// area, so that odd sizes keep their mean (a GL driver may weigh them differently).
#include "scene/texture_sampling.h"

#include <algorithm>
#include <mutex>

namespace brickfield {

namespace {

// Levels hold 16 bits a channel, linear: the smallest sRGB step, 1/(255 * 12.92), is still 20 of these steps.
constexpr float kLevelScale = 65535.0f;

struct Level {
  glm::uvec2 size{0};
  std::vector<std::uint16_t> rgba;
};

const std::array<float, 256>& linearFromSrgbBytes() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = linearFromSrgb(static_cast<float>(i) / 255.0f);
    return table;
  }();
  return kTable;
}

glm::vec4 decodeTexel(const std::uint8_t* rgba, TextureEncoding encoding) {
  const glm::vec4 plain = glm::vec4(rgba[0], rgba[1], rgba[2], rgba[3]) / 255.0f;
  if (encoding == TextureEncoding::Linear) return plain;
  const std::array<float, 256>& table = linearFromSrgbBytes();
  return {table[rgba[0]], table[rgba[1]], table[rgba[2]], plain.w};
}

/// A level of the chain: the image itself or a smaller one.
struct LevelReader {
  const Image* image = nullptr; ///< level 0
  const Level* level = nullptr; ///< level 1 and up
  TextureEncoding encoding = TextureEncoding::Linear;

  glm::uvec2 size() const { return level ? level->size : image->size; }
  glm::vec4 texel(std::uint32_t x, std::uint32_t y) const {
    const std::size_t offset = (std::size_t{y} * size().x + x) * 4;
    if (!level) return decodeTexel(&image->rgba[offset], encoding);
    const std::uint16_t* value = &level->rgba[offset];
    return glm::vec4(value[0], value[1], value[2], value[3]) / kLevelScale;
  }
};

/// The source texels under one texel of the next level, along one axis: first one, and the share of each.
struct BoxWeights {
  std::uint32_t first = 0;
  std::array<float, 4> weights{}; // the ratio of sizes is below 3 (3 to 1), so at most 4 texels are touched
  int count = 0;
};

BoxWeights boxWeights(std::uint32_t index, std::uint32_t sourceSize, std::uint32_t targetSize) {
  const double ratio = static_cast<double>(sourceSize) / targetSize;
  const double begin = index * ratio, end = (index + 1) * ratio;
  BoxWeights box;
  box.first = static_cast<std::uint32_t>(begin);
  for (std::uint32_t i = box.first; i < sourceSize && i < end && box.count < 4; ++i) {
    const double covered = std::min<double>(end, i + 1.0) - std::max<double>(begin, i);
    if (covered <= 1e-9) break;
    box.weights[static_cast<std::size_t>(box.count++)] = static_cast<float>(covered / ratio);
  }
  return box;
}

Level nextLevel(const LevelReader& source) {
  Level target;
  target.size = glm::max(source.size() / 2u, glm::uvec2(1));
  target.rgba.resize(std::size_t{target.size.x} * target.size.y * 4);
  for (std::uint32_t y = 0; y < target.size.y; ++y) {
    const BoxWeights rows = boxWeights(y, source.size().y, target.size.y);
    for (std::uint32_t x = 0; x < target.size.x; ++x) {
      const BoxWeights columns = boxWeights(x, source.size().x, target.size.x);
      glm::vec4 sum(0.0f);
      for (int j = 0; j < rows.count; ++j)
        for (int i = 0; i < columns.count; ++i)
          sum +=
              rows.weights[static_cast<std::size_t>(j)] * columns.weights[static_cast<std::size_t>(i)] *
              source.texel(columns.first + static_cast<std::uint32_t>(i), rows.first + static_cast<std::uint32_t>(j));
      for (int c = 0; c < 4; ++c)
        target.rgba[(std::size_t{y} * target.size.x + x) * 4 + static_cast<std::size_t>(c)] =
            static_cast<std::uint16_t>(std::clamp(sum[c], 0.0f, 1.0f) * kLevelScale + 0.5f);
    }
  }
  return target;
}

/// Brings a coordinate near the image, so that it fits an integer whatever the file says.
float reduceCoordinate(float coordinate, Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0.0f;
  switch (wrap) {
  case Wrap::Repeat:
    return coordinate - std::floor(coordinate);
  case Wrap::MirroredRepeat:
    return coordinate - 2.0f * std::floor(0.5f * coordinate);
  case Wrap::ClampToEdge:
    return std::clamp(coordinate, -1.0f, 2.0f);
  }
  return 0.0f;
}

std::uint32_t wrapIndex(std::int64_t index, std::uint32_t size, Wrap wrap) {
  const auto n = static_cast<std::int64_t>(size);
  switch (wrap) {
  case Wrap::Repeat:
    return static_cast<std::uint32_t>(((index % n) + n) % n);
  case Wrap::MirroredRepeat: {
    const std::int64_t period = ((index % (2 * n)) + 2 * n) % (2 * n);
    return static_cast<std::uint32_t>(period < n ? period : 2 * n - 1 - period);
  }
  case Wrap::ClampToEdge:
    break;
  }
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, n - 1));
}

glm::vec4 sampleLevel(const LevelReader& level, const SceneTexture& texture, Filter filter, glm::vec2 uv) {
  const glm::uvec2 size = level.size();
  const glm::vec2 position = uv * glm::vec2(size);
  const auto texel = [&](std::int64_t x, std::int64_t y) {
    return level.texel(wrapIndex(x, size.x, texture.wrapU), wrapIndex(y, size.y, texture.wrapV));
  };
  if (filter == Filter::Nearest)
    return texel(static_cast<std::int64_t>(std::floor(position.x)), static_cast<std::int64_t>(std::floor(position.y)));
  const glm::vec2 corner = glm::floor(position - 0.5f);
  const glm::vec2 weight = position - 0.5f - corner;
  const auto x = static_cast<std::int64_t>(corner.x), y = static_cast<std::int64_t>(corner.y);
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), weight.x),
                  glm::mix(texel(x, y + 1), texel(x + 1, y + 1), weight.x), weight.y);
}

} // namespace

struct TextureSampler::Pyramid {
  std::once_flag made;
  std::vector<Level> levels; ///< from half the size down to one texel
};

TextureSampler::TextureSampler(const Scene& scene)
    : scene_(scene), pyramids_(std::make_unique<Pyramid[]>(scene.images.size() * 2)) {}
TextureSampler::~TextureSampler() = default;

const TextureSampler::Pyramid& TextureSampler::pyramidOf(int image, TextureEncoding encoding) const {
  Pyramid& pyramid = pyramids_[static_cast<std::size_t>(image) * 2 + static_cast<std::size_t>(encoding)];
  std::call_once(pyramid.made, [&] {
    LevelReader reader{&scene_.images[static_cast<std::size_t>(image)], nullptr, encoding};
    std::vector<Level> levels;
    levels.reserve(32); // the reader points into it; a side has at most 32 bits
    while (reader.size().x > 1 || reader.size().y > 1) {
      levels.push_back(nextLevel(reader));
      reader.level = &levels.back();
    }
    pyramid.levels = std::move(levels);
  });
  return pyramid;
}

glm::vec4 TextureSampler::sample(int textureIndex, TextureEncoding encoding, glm::vec2 uvTexture,
                                 const glm::mat2& texturePerFootprint) const {
  if (textureIndex < 0) return glm::vec4(1.0f);
  const SceneTexture& texture = scene_.textures[static_cast<std::size_t>(textureIndex)];
  if (texture.image < 0) return glm::vec4(1.0f);
  const Image& image = scene_.images[static_cast<std::size_t>(texture.image)];
  if (image.rgba.empty()) return glm::vec4(1.0f);

  const glm::vec2 uv(reduceCoordinate(uvTexture.x, texture.wrapU), reduceCoordinate(uvTexture.y, texture.wrapV));
  const glm::vec2 size(image.size);
  const float widthTexels =
      std::max(glm::length(texturePerFootprint[0] * size), glm::length(texturePerFootprint[1] * size));
  const LevelReader base{&image, nullptr, encoding};
  if (!(widthTexels > 1.0f)) return sampleLevel(base, texture, texture.magnify, uv);
  if (!texture.mipmap) return sampleLevel(base, texture, texture.minify, uv);

  const std::vector<Level>& levels = pyramidOf(texture.image, encoding).levels;
  const auto reader = [&](std::size_t i) { return i == 0 ? base : LevelReader{&image, &levels[i - 1], encoding}; };
  const float level = std::min(std::log2(widthTexels), static_cast<float>(levels.size()));
  if (*texture.mipmap == Filter::Nearest)
    return sampleLevel(reader(static_cast<std::size_t>(level + 0.5f)), texture, texture.minify, uv);
  const auto fine = static_cast<std::size_t>(level);
  const std::size_t coarse = std::min(fine + 1, levels.size());
  return glm::mix(sampleLevel(reader(fine), texture, texture.minify, uv),
                  sampleLevel(reader(coarse), texture, texture.minify, uv), level - static_cast<float>(fine));
}

glm::vec4 TextureSampler::sampleSlot(const TextureSlot& slot, TextureEncoding encoding,
                                     const MaterialPoint& point) const {
  if (!slot.isUsed()) return glm::vec4(1.0f);
  const std::size_t set = slot.uvSet == 1 ? 1 : 0;
  const glm::vec2 uvTexture(slot.textureFromUv * glm::vec3(point.uv[set], 1.0f));
  return sample(slot.texture, encoding, uvTexture, glm::mat2(slot.textureFromUv) * point.uvPerFootprint[set]);
}

glm::vec4 TextureSampler::sampleBaseColor(const Material& material, const MaterialPoint& point) const {
  return material.baseColor * point.color * sampleSlot(material.baseColorTexture, TextureEncoding::Srgb, point);
}

MaterialSample TextureSampler::sampleMaterial(const Material& material, const MaterialPoint& point) const {
  MaterialSample result;
  result.baseColor = sampleBaseColor(material, point);
  const glm::vec4 metallicRoughness = sampleSlot(material.metallicRoughnessTexture, TextureEncoding::Linear, point);
  result.metallic = std::clamp(material.metallic * metallicRoughness.z, 0.0f, 1.0f);
  result.roughness = std::clamp(material.roughness * metallicRoughness.y, 0.0f, 1.0f);
  const float occlusion = sampleSlot(material.occlusionTexture, TextureEncoding::Linear, point).x;
  result.occlusion = 1.0f + material.occlusionStrength * (occlusion - 1.0f);
  result.emission = material.emission * glm::vec3(sampleSlot(material.emissionTexture, TextureEncoding::Srgb, point));
  if (material.normalTexture.isUsed()) {
    const glm::vec3 texel(sampleSlot(material.normalTexture, TextureEncoding::Linear, point));
    const glm::vec3 normal = (texel * 2.0f - 1.0f) * glm::vec3(material.normalScale, material.normalScale, 1.0f);
    const float length = glm::length(normal);
    if (length > 0.0f) result.normalTangent = normal / length;
  }
  return result;
}

MaterialPoint materialPointOf(const Primitive& primitive, std::size_t triangle, glm::vec2 barycentric) {
  const std::uint32_t* vertices = &primitive.indices[triangle * 3];
  const auto interpolate = [&](const auto& values) {
    return (1.0f - barycentric.x - barycentric.y) * values[vertices[0]] + barycentric.x * values[vertices[1]] +
           barycentric.y * values[vertices[2]];
  };
  MaterialPoint point;
  for (std::size_t set = 0; set < 2; ++set)
    if (!primitive.uvs[set].empty()) point.uv[set] = interpolate(primitive.uvs[set]);
  if (!primitive.colors.empty()) point.color = interpolate(primitive.colors);
  return point;
}

glm::mat2 uvPerFootprintOf(const std::array<glm::vec3, 3>& positions, const std::array<glm::vec2, 3>& uvs,
                           float width) {
  // Edges in an orthonormal frame of the triangle's plane: e1 = (a, 0), e2 = (b, c). The linear map that takes them to
  // the uv edges is [d1 d2] [e1 e2]^-1.
  const glm::vec3 e1 = positions[1] - positions[0], e2 = positions[2] - positions[0];
  const float a = glm::length(e1);
  const float area = glm::length(glm::cross(e1, e2));
  if (!(a > 0.0f) || !(area > 0.0f)) return glm::mat2(0.0f);
  const float b = glm::dot(e1, e2) / a, c = area / a;
  const glm::vec2 d1 = uvs[1] - uvs[0], d2 = uvs[2] - uvs[0];
  const glm::vec2 alongFirst = d1 / a;
  const glm::vec2 alongSecond = (d2 - alongFirst * b) / c;
  if (!isFinite(alongFirst) || !isFinite(alongSecond)) return glm::mat2(0.0f);
  return width * glm::mat2(alongFirst, alongSecond);
}

} // namespace brickfield
