// Where the world field is kept and which parts of it a frame must make anew: cascades of cubic windows on lattices
// through an anchor, cut in tiles of 8^3 texels. No GL; the passes under passes/world_field do what is planned here.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace brickfield {

inline constexpr int kFieldTileTexels = 8; ///< along a side

/// One cascade's part of the world. A texel's centre lies at (lattice + 0.5) * texelSize from the anchor.
struct FieldWindow {
  glm::ivec3 firstTexel{0}; ///< lattice; a multiple of kFieldTileTexels
  int texels = 128;         ///< along a side, a power of two from 16 to 512
  double texelSize = 1;     ///< metres
  bool isWhole = false;     ///< nothing that counts lies outside

  int tiles() const { return texels / kFieldTileTexels; }
  /// Largest magnitude that the field holds; beyond it only the sign is kept. It is what a change reaches, so it is as
  /// short as steps of rays allow.
  int rangeTexels() const { return std::min(texels / 8, 16); }
  Box boundsAnchored() const;
  bool operator==(const FieldWindow&) const = default;
};

/// What the user asks for.
struct FieldShape {
  int cascades = 4;     ///< 1 to 8
  int texels = 128;     ///< along a cascade's side
  double texelSize = 0; ///< metres, of the finest cascade; 0: so that the coarsest covers the scene
  bool isWhole = false; ///< one window around the whole scene instead of cascades around the eye

  bool operator==(const FieldShape&) const = default;
};

/// The windows for an eye: each cascade's texels are twice as large as the one's before. A window is centred on the eye
/// to half a tile, as far as it can be without looking past the scene: seen from outside, the scene and not the void is
/// held. Or the one window around `boundsAnchored` with a margin of two texels. A function of its arguments alone.
///
/// boundsAnchored  of the scene, metres from the anchor; empty or not finite counts as one metre
/// proved by tests/unit/field/field_windows_test.cpp
std::vector<FieldWindow> fieldWindows(const FieldShape& shape, const Box& boundsAnchored, glm::dvec3 eyeAnchored);
/// Metres of the finest texels of these windows: the shape's, or so that the coarsest window holds the bounds.
double fieldTexelSize(const FieldShape& shape, const Box& boundsAnchored);

/// Tiles to work on, as words of fieldTileWord, ascending. Each list is what one stage must write so that the next
/// finds what it reads.
struct FieldUpdate {
  std::vector<std::uint32_t> keys;       ///< surface keys: what moved, what it left, what scrolled in
  std::vector<std::uint32_t> planes;     ///< nearest coarse seeds in planes across z
  std::vector<std::uint32_t> depths;     ///< and of all
  std::vector<std::uint32_t> candidates; ///< nearest triangles: all that the changed keys can reach
  std::vector<std::uint32_t> values;     ///< distances: candidates, and what moving SDF objects reach

  bool isEmpty() const { return values.empty(); }
};

/// cascade << 24 | slot of the tile: where it lies in memory, x fastest.
std::uint32_t fieldTileWord(std::size_t cascade, const FieldWindow& window, glm::ivec3 tileLattice);

/// The tile that lies in a slot: the way back.
glm::ivec3 fieldTileLattice(const FieldWindow& window, std::uint32_t slot);

/// Texels of a lattice from min to max, both included; empty where they cross.
struct TexelBox {
  glm::ivec3 min{1 << 28}, max{-(1 << 28)};
  bool isEmpty() const { return glm::any(glm::greaterThan(min, max)); }
};
/// The box of all tiles of a list, a cascade each.
std::vector<TexelBox> boundsOfTiles(const std::vector<FieldWindow>& windows, const std::vector<std::uint32_t>& words);

/// Plans updates from frame to frame.
class FieldUpdatePlanner {
public:
  /// Everything is new at the next plan.
  void reset() { windows_.clear(); }

  /// windows  of this frame
  /// meshes   boxes, metres from the anchor, of every mesh instance that changed: where it was and where it is
  /// objects  the same of SDF objects
  FieldUpdate plan(const std::vector<FieldWindow>& windows, std::span<const Box> meshes, std::span<const Box> objects);

private:
  std::vector<FieldWindow> windows_; ///< of the frame before
};

/// Distance, in texels, up to which a triangle leaves its key in the texels around it.
inline constexpr float kFieldSplatTexels = 2.0f;
/// How far the sweeps over coarse seeds look, in coarse texels of two. At least what field_candidates needs for signs.
inline int fieldSweepReach(int rangeTexels) { return std::max(rangeTexels / 2 + 2, 8); }

} // namespace brickfield
