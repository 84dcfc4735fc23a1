// One level as a lattice of distances without holes: every grid point has one value, whichever brick or cell asks. So
// what is made of it fits together even where a file's bricks contradict each other.
#pragma once

#include <array>

#include "field/brick_lookup.h"

namespace brickfield {

class LevelLattice {
public:
  /// level  sound (validateField); must outlive this
  explicit LevelLattice(const BrickLevel& level) : level_(&level) {}

  /// Distance in voxels at a grid point. Stored samples win, those of the last brick that holds the point; else the
  /// bound of an empty cell with its sign, at least 1; beyond the grid 1: outside.
  double at(glm::ivec3 point) const;

  /// What at() gives at the 512 points of a brick, i fastest. The brick may lie beside the grid.
  std::array<double, kBrickSampleCount> ofBrick(glm::ivec3 brick) const;

  /// Whether the sign may change between points of a brick: it is stored, or one of its 26 neighbours is or has
  /// another sign. Bricks beside the grid count as empty ones outside.
  bool mayChangeSign(glm::ivec3 brick) const;

private:
  IndirectionCell cell(glm::ivec3 brick) const;

  const BrickLevel* level_;
};

} // namespace brickfield
