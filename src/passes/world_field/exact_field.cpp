// Sizes, uploads, and the coding of keys.
#include "passes/world_field/exact_field.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr float kSheetHalfTexels = 0.5f;
/// Shaders reach no farther into a buffer.
constexpr std::size_t kMostBytes = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t kLeastSearches = std::size_t{3} << 18;
constexpr int kLeastKeyDistanceBits = 6; // steps of 1/28 texel: what they confuse, the evaluation rounds sort out

std::size_t texelsOf(const FieldWindow& window) {
  return static_cast<std::size_t>(window.texels) * window.texels * window.texels;
}

constexpr std::array<const char*, ExactField::kLists> kListLabels = {
    "field_key_tiles", "field_plane_tiles", "field_depth_tiles", "field_candidate_tiles", "field_value_tiles"};

} // namespace

ExactField::ExactField()
    : params_("field_params", sizeof(shared::FieldParams)),
      splats_("field_splats", sizeof(shared::FieldSplat)),
      parts_("field_splat_parts", 16 + std::size_t{shared::SPLAT_PART_CAPACITY} * 8),
      objects_("field_objects", 4096) {
  for (std::size_t i = 0; i < kLists; ++i) lists_[i] = Buffer(kListLabels[i], 4096);
}

bool ExactField::fit(const std::vector<FieldWindow>& windows) {
  const auto isSameSize = [](const FieldWindow& a, const FieldWindow& b) { return a.texels == b.texels; };
  if (std::equal(windows.begin(), windows.end(), windows_.begin(), windows_.end(), isSameSize)) return false;
  std::size_t texels = 0;
  for (const FieldWindow& window : windows) texels += texelsOf(window);
  const std::size_t words = texels * sizeof(std::uint32_t);
  if (words > kMostBytes)
    throw BadInput(
        "world field", "size",
        fmt::format("{} texels need buffers of {} bytes, of which shaders reach {}", texels, words, kMostBytes));
  *this = ExactField();
  keys_ = Buffer("field_keys", words);
  nodes_ = Buffer("field_nodes", words);
  seeds_ = Buffer("field_seeds", words / 8);
  sweeps_ = Buffer("field_sweeps", words / 8);
  candidates_ = Buffer("field_candidates", words / 8 + words / 16); // and their distances, as halves
  tiles_ = Buffer("field_tiles", texels / shared::FIELD_TILE_TEXELS * sizeof(shared::FieldTile));
  tiles_.clear(0);
  const std::size_t tileWords = texels / shared::FIELD_TILE_TEXELS * sizeof(std::uint32_t);
  sides_ = Buffer("field_sides", tileWords);
  sides_.clear(shared::FIELD_SIDE_UNKNOWN);
  flips_ = Buffer("field_flips", 16 + tileWords);
  searches_ = Buffer("field_searches", (kLeastSearches + texels / 8) * sizeof(shared::FieldSearch));
  open_ = Buffer("field_open", 8 + 2 * tileWords);
  band_ = Buffer("field_band", 4 + tileWords);
  band_.clear(0);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    Texture& texture = distances_.emplace_back(
        Texture::make3D(fmt::format("field_distance_{}", i), GL_R16F, glm::ivec3(windows[i].texels)));
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTextureParameteri(texture.id(), axis, GL_REPEAT);
  }
  windows_ = windows;
  return true;
}

void ExactField::uploadList(List list, const std::vector<std::uint32_t>& words) {
  const auto i = static_cast<std::size_t>(list);
  lists_[i].growTo(words.size() * sizeof(std::uint32_t));
  lists_[i].upload(0, words);
  lengths_[i] = static_cast<std::uint32_t>(words.size());
}

void ExactField::prepare(const std::vector<FieldWindow>& windows, const FieldWork& work) {
  windows_ = windows;
  uploadList(List::Keys, work.tiles.keys);
  uploadList(List::Planes, work.tiles.planes);
  uploadList(List::Depths, work.tiles.depths);
  uploadList(List::Candidates, work.tiles.candidates);
  uploadList(List::Values, work.tiles.values);
  splats_.growTo(work.splats.size() * sizeof(shared::FieldSplat));
  splats_.upload(0, work.splats);
  splatCount_ = static_cast<std::uint32_t>(work.splats.size());
  objects_.growTo(work.objects.size() * sizeof(shared::FieldObjectRow));
  objects_.upload(0, work.objects);

  // The largest number is never used: a key of ones alone is no key.
  const int triangleBits = std::max(static_cast<int>(std::bit_width(work.triangleCount)), 1);
  if (32 - triangleBits < kLeastKeyDistanceBits)
    throw Failure(fmt::format("world field: {} triangles are more than its keys can number", work.triangleCount));
  shared::FieldParams params{};
  std::uint32_t firstTexel = 0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const FieldWindow& window = windows[i];
    shared::FieldCascade& row = params.cascades[i];
    row.window = glm::ivec4(window.firstTexel, window.texels);
    row.texel = {window.texelSize, 1.0 / window.texelSize, window.rangeTexels(), kSheetHalfTexels};
    row.buffers = {firstTexel, firstTexel / 8, firstTexel / shared::FIELD_TILE_TEXELS,
                   window.isWhole ? shared::FIELD_WHOLE : 0u};
    row.extent = glm::vec4(glm::vec3(static_cast<float>(window.texels)), 0);
    params.splatMin[i] = glm::ivec4(work.keyBounds[i].min, 0);
    params.splatMax[i] = glm::ivec4(work.keyBounds[i].max, 0);
    firstTexel += static_cast<std::uint32_t>(texelsOf(window));
  }
  params.counts = {windows.size(), triangleBits, work.objects.size(), ++update_};
  params.coarse.x = firstTexel / 8;
  params.anchor = glm::vec4(work.anchorWorld, 0);
  params_.uploadValue(params);
}

std::size_t ExactField::bytes() const {
  std::size_t sum = 0;
  for (const Texture& texture : distances_) sum += texture.bytes();
  for (const Buffer& list : lists_) sum += list.bytes();
  for (const Buffer* buffer : {&params_, &splats_, &parts_, &objects_, &keys_, &nodes_, &seeds_, &sweeps_, &candidates_,
                               &tiles_, &sides_, &flips_, &searches_, &open_, &band_})
    sum += buffer->bytes();
  return sum;
}

} // namespace brickfield
