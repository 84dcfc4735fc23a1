// Lookups by grid point.
#include "field/level_lattice.h"

#include "field/brick_layout.h"

namespace brickfield {

namespace {
// A cell without a brick has no surface within kTouchVoxels, or its field makes no sense.
constexpr float kLeastBound = kTouchVoxels;

bool isWithin(glm::ivec3 at, glm::ivec3 most) {
  return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThanEqual(at, most));
}
} // namespace

IndirectionCell LevelLattice::cell(glm::ivec3 brick) const {
  if (!isWithin(brick, level_->brickCounts - 1)) return IndirectionCell::empty(false, kLeastBound);
  return cellAt(*level_, brick);
}

double LevelLattice::at(glm::ivec3 point) const {
  if (!isWithin(point, kBrickCells * level_->brickCounts)) return kLeastBound;
  const glm::ivec3 last = glm::min(point / kBrickCells, level_->brickCounts - 1);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 brick = last - glm::ivec3(i & 1, i >> 1 & 1, i >> 2), sample = point - kBrickCells * brick;
    if (glm::any(glm::lessThan(brick, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(sample, glm::ivec3(kBrickSamples))))
      continue;
    const IndirectionCell found = cellAt(*level_, brick);
    if (!found.isEmpty()) return storedDistance(*level_, found.brickIndex(), sample);
  }
  const IndirectionCell empty = cellAt(*level_, last);
  const float bound = std::max(empty.boundVoxels(), kLeastBound);
  return empty.isInside() ? -bound : bound;
}

std::array<double, kBrickSampleCount> LevelLattice::ofBrick(glm::ivec3 brick) const {
  std::array<double, kBrickSampleCount> values;
  const IndirectionCell own = cell(brick);
  for (int z = 0; z < kBrickSamples; ++z)
    for (int y = 0; y < kBrickSamples; ++y)
      for (int x = 0; x < kBrickSamples; ++x) {
        const glm::ivec3 sample(x, y, z);
        const bool isShared = glm::any(glm::equal(sample % kBrickCells, glm::ivec3(0)));
        values[sampleIndex(sample)] = own.isEmpty() || isShared ? at(kBrickCells * brick + sample)
                                                                : storedDistance(*level_, own.brickIndex(), sample);
      }
  return values;
}

bool LevelLattice::mayChangeSign(glm::ivec3 brick) const {
  const IndirectionCell own = cell(brick);
  if (!own.isEmpty()) return true;
  for (int i = 0; i < 27; ++i) {
    const IndirectionCell other = cell(brick + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);
    if (!other.isEmpty() || other.isInside() != own.isInside()) return true;
  }
  return false;
}

} // namespace brickfield
