// The exact world field on the GPU: its cascades' textures and buffers, and the lists of one update. The passes beside
// it (field_splat, field_candidates, field_resolve) fill it; what is planned comes from field/field_windows.h.
#pragma once

#include <array>
#include <vector>

#include "field/field_windows.h"
#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "shared/bindings.h"
#include "shared/world_field_params.h"

namespace brickfield {

/// Everything that one update works on.
struct FieldWork {
  FieldUpdate tiles;
  std::vector<TexelBox> keyBounds;        ///< a cascade: the box of all tiles.keys
  std::vector<shared::FieldSplat> splats; ///< triangles that may reach the tiles whose keys are made anew
  glm::dvec3 anchorWorld{0};
  std::uint32_t triangleCount = 0;             ///< numbers that may occur, for the coding of keys
  std::vector<shared::FieldObjectRow> objects; ///< a row each SDF instance
};

class ExactField {
public:
  /// Tile lists of one update, in the order of its stages.
  enum class List : std::uint8_t { Keys, Planes, Depths, Candidates, Values };
  static constexpr std::size_t kLists = 5;

  ExactField();

  /// Makes room for these windows.
  /// returns whether the content was lost: number or size of the cascades is another
  /// error   BadInput: shaders cannot reach the end of its buffers; Failure: the device has no memory for them
  bool fit(const std::vector<FieldWindow>& windows);
  /// Uploads an update. error Failure: more triangles than keys can number
  void prepare(const std::vector<FieldWindow>& windows, const FieldWork& work);

  const std::vector<FieldWindow>& windows() const { return windows_; }
  bool hasWork() const { return lengthOf(List::Values) > 0; }
  const Buffer& list(List list) const { return lists_[static_cast<std::size_t>(list)]; } ///< words, ascending
  std::uint32_t lengthOf(List list) const { return lengths_[static_cast<std::size_t>(list)]; }
  std::uint32_t splatCount() const { return splatCount_; }

  /// Distances in texels of the cascade, signed, at most FieldWindow::rangeTexels() large; wraps around.
  const Texture& distances(std::size_t cascade) const { return distances_[cascade]; }
  const Buffer& nodes() const { return nodes_; } ///< a word a texel: FIELD_NODE_*
  const Buffer& keys() const { return keys_; }
  const Buffer& tiles() const { return tiles_; }

  void bindParams() const { params_.bindUniform(shared::kFieldUniformBinding); }
  void bindList(List list) const { lists_[static_cast<std::size_t>(list)].bindStorage(shared::kFieldListBinding); }
  void bindSplats() const { splats_.bindStorage(shared::kFieldListBinding); }
  void bindObjects() const { objects_.bindStorage(shared::kFieldObjectBinding); }
  void bindParts() const { parts_.bindStorage(shared::kFieldSplatBinding); }
  void bindKeys() const { keys_.bindStorage(shared::kFieldKeyBinding); }
  void bindSeeds() const { seeds_.bindStorage(shared::kFieldSeedBinding); }
  void bindSweeps() const { sweeps_.bindStorage(shared::kFieldSweepBinding); }
  void bindCandidates() const { candidates_.bindStorage(shared::kFieldCandidateBinding); }
  void bindNodes() const { nodes_.bindStorage(shared::kFieldNodeBinding); }
  void bindTiles() const { tiles_.bindStorage(shared::kFieldTileBinding); }
  void bindSides() const { sides_.bindStorage(shared::kFieldSideBinding); }
  /// Tiles whose side was another one before this update: the groups of a dispatch, their count, their words.
  const Buffer& flips() const { return flips_; }
  /// Texels for which SDF objects are to be searched, and the tiles in which they lie.
  void bindSearches() const {
    searches_.bindStorage(shared::kFieldSearchBinding);
    open_.bindStorage(shared::kFieldOpenBinding);
  }
  /// Of what an update counts on the GPU.
  void clearCounts() {
    flips_.clear(0, 0, 16);
    open_.clear(0, 0, 8);
  }
  std::uint32_t tileCount() const { return static_cast<std::uint32_t>(tiles_.bytes() / sizeof(shared::FieldTile)); }
  const Buffer& band() const { return band_; } ///< a count, and the tiles of this update with texels near a surface

  std::size_t bytes() const;

private:
  void uploadList(List list, const std::vector<std::uint32_t>& words);

  std::vector<FieldWindow> windows_;
  std::vector<Texture> distances_;
  std::array<Buffer, kLists> lists_;
  std::array<std::uint32_t, kLists> lengths_{};
  Buffer params_, splats_, parts_, objects_;
  Buffer keys_, nodes_;                ///< a word a texel
  Buffer seeds_, sweeps_, candidates_; ///< a word a coarse texel
  Buffer tiles_, band_;
  Buffer sides_; ///< a word a tile: FIELD_SIDE_*
  Buffer flips_;
  Buffer searches_, open_; ///< rows of shared::FieldSearch; two counts and two words a tile
  std::uint32_t splatCount_ = 0, update_ = 0;
};

} // namespace brickfield
