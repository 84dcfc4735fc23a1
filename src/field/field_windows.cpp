// Dirt spreads by boxes: a changed key reaches as far as the range, and a little for the texels that share candidates.
#include "field/field_windows.h"

#include <algorithm>
#include <cmath>

namespace brickfield {

namespace {

// From a key to the values it can change: the texels of its coarse seed (1), the sweeps' reach (4 more than the range),
// the candidates that coarse neighbours (2) and fine ones (3) exchange.
constexpr int kSpreadBeyondRange = 10;
constexpr int kWindowMargin = 2; // around a whole scene, so that its surface has texels outside

/// Texels or tiles from `min` to `max`, both included; empty where min > max.
struct LatticeBox {
  glm::ivec3 min, max;

  bool isEmpty() const { return glm::any(glm::greaterThan(min, max)); }
  LatticeBox expanded(int margin) const { return {min - margin, max + margin}; }
  LatticeBox expanded(glm::ivec3 margin) const { return {min - margin, max + margin}; }
  LatticeBox within(const LatticeBox& other) const { return {glm::max(min, other.min), glm::min(max, other.max)}; }
};

LatticeBox latticeOf(const FieldWindow& window) { return {window.firstTexel, window.firstTexel + window.texels - 1}; }

/// The texels whose centres lie within a box of metres, or a texel outside of it. Boxes that are not finite are all.
LatticeBox texelsOf(const Box& box, const FieldWindow& window) {
  if (!isFinite(box.min) || !isFinite(box.max)) return latticeOf(window);
  const auto lattice = [&](glm::vec3 point, auto round) {
    const glm::dvec3 texel = glm::clamp(glm::dvec3(point) / window.texelSize, -1e9, 1e9);
    return glm::ivec3(round(texel.x), round(texel.y), round(texel.z));
  };
  return {lattice(box.min, [](double x) { return std::floor(x); }) - 1,
          lattice(box.max, [](double x) { return std::ceil(x); })};
}

glm::ivec3 tileOf(glm::ivec3 texel) { return texel >> 3; } // floors below zero as well

/// Flags of one cascade's tiles, and their list.
class TileFlags {
public:
  TileFlags(std::size_t cascade, const FieldWindow& window)
      : cascade_(cascade), window_(window), firstTile_(tileOf(window.firstTexel)) {
    flags_.resize(static_cast<std::size_t>(window.tiles()) * window.tiles() * window.tiles(), false);
  }
  void markTiles(const LatticeBox& tiles) {
    const LatticeBox box = tiles.within({firstTile_, firstTile_ + window_.tiles() - 1});
    if (box.isEmpty()) return;
    for (int z = box.min.z; z <= box.max.z; ++z)
      for (int y = box.min.y; y <= box.max.y; ++y) {
        const glm::ivec3 at = glm::ivec3(box.min.x, y, z) - firstTile_;
        const auto row =
            flags_.begin() + (static_cast<std::ptrdiff_t>(at.z) * window_.tiles() + at.y) * window_.tiles();
        std::fill(row + at.x, row + at.x + (box.max.x - box.min.x + 1), true);
      }
  }
  void append(std::vector<std::uint32_t>& words) const {
    std::size_t i = 0;
    const auto first = static_cast<std::ptrdiff_t>(words.size());
    for (int z = 0; z < window_.tiles(); ++z)
      for (int y = 0; y < window_.tiles(); ++y)
        for (int x = 0; x < window_.tiles(); ++x, ++i)
          if (flags_[i]) words.push_back(fieldTileWord(cascade_, window_, firstTile_ + glm::ivec3(x, y, z)));
    std::sort(words.begin() + first, words.end());
  }

private:
  std::size_t cascade_;
  const FieldWindow& window_;
  glm::ivec3 firstTile_;
  std::vector<bool> flags_;
};

/// The parts of a window that the window before did not hold, and those along its borders where what lies beyond them
/// has changed: values near a border end at it.
struct Scrolled {
  std::vector<LatticeBox> entered, borders;
};

Scrolled scrolledParts(const FieldWindow& before, const FieldWindow& now) {
  Scrolled parts;
  const LatticeBox box = latticeOf(now), old = latticeOf(before);
  for (int axis = 0; axis < 3; ++axis) {
    const int shift = now.firstTexel[axis] - before.firstTexel[axis];
    if (shift == 0) continue;
    LatticeBox slab = box, border = box;
    if (shift > 0) {
      slab.min[axis] = std::max(slab.min[axis], old.max[axis] + 1);
      border.max[axis] = border.min[axis];
    } else {
      slab.max[axis] = std::min(slab.max[axis], old.min[axis] - 1);
      border.min[axis] = border.max[axis];
    }
    parts.entered.push_back(slab);
    parts.borders.push_back(border);
  }
  return parts;
}

/// Plans one cascade.
class CascadeUpdate {
public:
  CascadeUpdate(std::size_t cascade, const FieldWindow& window)
      : window_(window),
        keys_(cascade, window),
        planes_(cascade, window),
        depths_(cascade, window),
        candidates_(cascade, window),
        values_(cascade, window) {}

  void changeKeys(const LatticeBox& texels) {
    const LatticeBox inside = texels.within(latticeOf(window_));
    if (inside.isEmpty()) return;
    keys_.markTiles(tilesOf(inside));
    changeCandidates(inside);
  }
  void changeCandidates(const LatticeBox& texels) {
    const LatticeBox tiles = tilesOf(texels.expanded(window_.rangeTexels() + kSpreadBeyondRange));
    const int reach = (2 * fieldSweepReach(window_.rangeTexels()) + kFieldTileTexels - 1) / kFieldTileTexels;
    candidates_.markTiles(tiles);
    values_.markTiles(tiles);
    depths_.markTiles(tiles.expanded(1)); // coarse neighbours are read as well
    planes_.markTiles(tiles.expanded(glm::ivec3(1, 1, 1 + reach)));
  }
  void changeObjects(const LatticeBox& texels) {
    values_.markTiles(tilesOf(texels.expanded(window_.rangeTexels() + 1)));
  }
  void append(FieldUpdate& update) const {
    keys_.append(update.keys);
    planes_.append(update.planes);
    depths_.append(update.depths);
    candidates_.append(update.candidates);
    values_.append(update.values);
  }

private:
  static LatticeBox tilesOf(const LatticeBox& texels) { return {tileOf(texels.min), tileOf(texels.max)}; }

  const FieldWindow& window_;
  TileFlags keys_, planes_, depths_, candidates_, values_;
};

} // namespace

Box FieldWindow::boundsAnchored() const {
  const glm::dvec3 min = glm::dvec3(firstTexel) * texelSize;
  return {glm::vec3(min), glm::vec3(min + texels * texelSize)};
}

std::uint32_t fieldTileWord(std::size_t cascade, const FieldWindow& window, glm::ivec3 tileLattice) {
  const glm::ivec3 slot = tileLattice & (window.tiles() - 1);
  return static_cast<std::uint32_t>(cascade << 24) |
         static_cast<std::uint32_t>((slot.z * window.tiles() + slot.y) * window.tiles() + slot.x);
}

namespace {

Box boundsOrMetre(const Box& bounds) {
  const bool isUsable = !bounds.isEmpty() && isFinite(bounds.min) && isFinite(bounds.max);
  return isUsable ? bounds : Box{glm::vec3(-0.5f), glm::vec3(0.5f)};
}

// Windows begin at tiles: up to half a tile is lost where the anchor is not the centre.
constexpr int kRoundedMargin = kWindowMargin + kFieldTileTexels / 2;

int marginOf(const FieldShape& shape, const Box& bounds) {
  return shape.isWhole && glm::dvec3(bounds.min) == -glm::dvec3(bounds.max) ? kWindowMargin : kRoundedMargin;
}

/// The first texel of a window around a centre, at a tile.
int firstTexelAround(double center, const FieldWindow& window) {
  const double tile = window.texelSize * kFieldTileTexels;
  return static_cast<int>(std::floor(center / tile + 0.5)) * kFieldTileTexels - window.texels / 2;
}

} // namespace

double fieldTexelSize(const FieldShape& shape, const Box& boundsAnchored) {
  if (shape.texelSize > 0) return shape.texelSize;
  const Box bounds = boundsOrMetre(boundsAnchored);
  const glm::dvec3 extent = glm::dvec3(bounds.max) - glm::dvec3(bounds.min);
  double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) longest = 1; // one point
  const int cascades = shape.isWhole ? 1 : shape.cascades;
  return longest / ((shape.texels - 2 * marginOf(shape, bounds)) * std::exp2(cascades - 1));
}

glm::ivec3 fieldTileLattice(const FieldWindow& window, std::uint32_t slot) {
  const auto tiles = static_cast<std::uint32_t>(window.tiles());
  const glm::ivec3 at(slot % tiles, slot / tiles % tiles, slot / (tiles * tiles));
  const glm::ivec3 first = tileOf(window.firstTexel);
  return first + ((at - first) & (window.tiles() - 1));
}

std::vector<TexelBox> boundsOfTiles(const std::vector<FieldWindow>& windows, const std::vector<std::uint32_t>& words) {
  std::vector<TexelBox> boxes(windows.size());
  for (const std::uint32_t word : words) {
    TexelBox& box = boxes[word >> 24];
    const glm::ivec3 texel = fieldTileLattice(windows[word >> 24], word & 0xffffffu) * kFieldTileTexels;
    box.min = glm::min(box.min, texel);
    box.max = glm::max(box.max, texel + kFieldTileTexels - 1);
  }
  return boxes;
}

std::vector<FieldWindow> fieldWindows(const FieldShape& shape, const Box& boundsAnchored, glm::dvec3 eyeAnchored) {
  const Box bounds = boundsOrMetre(boundsAnchored);
  const glm::dvec3 least(bounds.min), most(bounds.max);
  FieldWindow window{glm::ivec3(0), shape.texels, fieldTexelSize(shape, bounds), shape.isWhole};
  std::vector<FieldWindow> windows;
  for (int cascade = 0; cascade < (shape.isWhole ? 1 : shape.cascades); ++cascade, window.texelSize *= 2) {
    // Centres whose windows end where the scene does; the other way round where it is smaller than the window.
    const double reach = (0.5 * window.texels - kRoundedMargin) * window.texelSize;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = least[axis] + reach, b = most[axis] - reach;
      const double center = shape.isWhole ? 0.5 * (least[axis] + most[axis])
                                          : std::clamp(eyeAnchored[axis], std::min(a, b), std::max(a, b));
      window.firstTexel[axis] = firstTexelAround(center, window);
    }
    windows.push_back(window);
  }
  return windows;
}

FieldUpdate FieldUpdatePlanner::plan(const std::vector<FieldWindow>& windows, std::span<const Box> meshes,
                                     std::span<const Box> objects) {
  FieldUpdate update;
  for (std::size_t cascade = 0; cascade < windows.size(); ++cascade) {
    const FieldWindow& window = windows[cascade];
    CascadeUpdate tiles(cascade, window);
    const FieldWindow* before = cascade < windows_.size() ? &windows_[cascade] : nullptr;
    if (!before || before->texels != window.texels || before->texelSize != window.texelSize ||
        before->isWhole != window.isWhole) {
      tiles.changeKeys(latticeOf(window));
    } else {
      const Scrolled scrolled = scrolledParts(*before, window);
      for (const LatticeBox& slab : scrolled.entered) tiles.changeKeys(slab);
      for (const LatticeBox& border : scrolled.borders) tiles.changeCandidates(border);
    }
    const int splat = static_cast<int>(std::ceil(kFieldSplatTexels));
    for (const Box& box : meshes)
      if (!box.isEmpty()) tiles.changeKeys(texelsOf(box, window).expanded(splat));
    for (const Box& box : objects)
      if (!box.isEmpty()) tiles.changeObjects(texelsOf(box, window));
    tiles.append(update);
  }
  windows_ = windows;
  return update;
}

} // namespace brickfield
