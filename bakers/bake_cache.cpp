// Content hash and cache. An entry is HASH.bricks; it is written beside and renamed, so another process sees a whole
// entry or none. What cannot be read is baked anew and replaced; what cannot be written is not cached. Neither is
// silent.
#include <chrono>
#include <cstdlib>

#include <fmt/format.h>

#include "bakers/bake.h"
#include "core/error.h"
#include "core/files.h"
#include "field/bricks_file.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kBakerVersion = 22; // raise it whenever the same input gives other bytes

void addTexture(Hasher& hasher, const Scene& scene, const TextureSlot& slot) {
  hasher.add(slot.texture);
  if (!slot.isUsed()) return;
  hasher.add(slot.uvSet);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) hasher.add(slot.textureFromUv[column][row]);
  const SceneTexture& texture = scene.textures[static_cast<std::size_t>(slot.texture)];
  hasher.add(texture.wrapU).add(texture.wrapV).add(texture.magnify).add(texture.minify).add(texture.mipmap.has_value());
  if (texture.mipmap) hasher.add(*texture.mipmap);
  hasher.add(texture.image);
  if (texture.image < 0) return;
  const Image& image = scene.images[static_cast<std::size_t>(texture.image)];
  hasher.add(image.size.x).add(image.size.y).addArray(image.rgba);
}

// All of it even without attributes: alpha mode and mask decide what counts as a sheet and how it is cut.
void addMaterial(Hasher& hasher, const Scene& scene, const Material& material) {
  hasher.add(material.alphaMode);
  for (int i = 0; i < 4; ++i) hasher.add(material.baseColor[i]);
  for (int i = 0; i < 3; ++i) hasher.add(material.emission[i]);
  hasher.add(material.metallic).add(material.roughness).add(material.occlusionStrength);
  hasher.add(material.alphaCutoff).add(material.unlit).add(material.doubleSided);
  addTexture(hasher, scene, material.baseColorTexture);
  addTexture(hasher, scene, material.metallicRoughnessTexture);
  addTexture(hasher, scene, material.occlusionTexture);
  addTexture(hasher, scene, material.emissionTexture);
}

/// The cached field, or why there is none that can be used.
struct CacheEntry {
  std::optional<BrickField> field;
  std::string warning; ///< names the file; empty where there is none, as before every first bake
};

CacheEntry readEntry(const std::filesystem::path& path, const Hash128& hash) {
  CacheEntry entry;
  std::error_code ec;
  if (std::filesystem::symlink_status(path, ec).type() == std::filesystem::file_type::not_found) return entry;
  try {
    entry.field = readBricksFile(path);
    if (entry.field->sourceHash == hash) return entry;
    entry.field.reset();
    entry.warning = path.string() + ": holds another bake";
  } catch (const BadInput& error) {
    entry.warning = error.what();
  }
  entry.warning += "; baked anew";
  return entry;
}

/// returns why nothing was stored, naming the folder; empty: it was
std::string writeEntry(const std::filesystem::path& path, const BrickField& field) {
  const std::filesystem::path folder = path.parent_path();
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  if (ec) return fmt::format("{}: {}; nothing is cached", folder.string(), ec.message());
  try {
    writeBricksFile(path, field);
    return "";
  } catch (const BadInput&) {
    const std::string obstacle = obstacleToWriting(path);
    return fmt::format("{}: {}; nothing is cached", folder.string(), obstacle.empty() ? "cannot be written" : obstacle);
  }
}

} // namespace

Hash128 bakeHash(const BakeInput& input, const BakeSettings& settings) {
  Hasher hasher;
  hasher.add(kBakerVersion).add(settings.resolution).add(settings.bits).add(settings.mips).add(settings.sign);
  hasher.add(settings.thickness).add(settings.attributes);
  for (int i = 0; i < 3; ++i) hasher.add(input.seenFromObject[i]);
  for (std::size_t i = 0; i < input.primitives.size(); ++i) {
    const Primitive& primitive = *input.primitives[i];
    hasher.addArray(primitive.indices).addArray(input.positionsObject[i]);
    hasher.addArray(primitive.uvs[0]).addArray(primitive.uvs[1]).addArray(primitive.colors);
    addMaterial(hasher, *input.scene, materialOf(*input.scene, primitive));
  }
  return hasher.finish();
}

BakeResult bakeCached(const BakeInput& input, const BakeSettings& settings, const std::filesystem::path& cacheFolder,
                      const Progress& progress, bool* wasCached) {
  if (wasCached) *wasCached = false;
  if (cacheFolder.empty()) return bakeField(input, settings, progress);
  const auto start = std::chrono::steady_clock::now();
  const Hash128 hash = bakeHash(input, settings);
  const std::filesystem::path path = cacheFolder / (hash.text() + ".bricks");
  CacheEntry entry = readEntry(path, hash);
  if (entry.field) {
    BakeResult result;
    result.field = std::move(*entry.field);
    result.stats.sign = "cached";
    for (const BrickLevel& level : result.field.levels) result.stats.bricks += level.brickCount();
    result.stats.bytes = fieldBytes(result.field);
    result.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (wasCached) *wasCached = true;
    return result;
  }
  BakeResult result = bakeField(input, settings, progress);
  result.cacheWarning = writeEntry(path, result.field);
  if (!entry.warning.empty()) result.cacheWarning = std::move(entry.warning); // the cause, where both go wrong
  return result;
}

std::filesystem::path defaultCacheFolder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (const auto folder = variable("XDG_CACHE_HOME"); !folder.empty()) return folder / "brickfield";
  if (const auto home = variable("HOME"); !home.empty()) return home / ".cache" / "brickfield";
  return {};
}

} // namespace brickfield
