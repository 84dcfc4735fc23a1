// What rims make of the winding number at all samples of a brick at once: eight samples against each edge. Near rims
// are closed by curtains, which hang from their edges down along z without end, far ones by surfaces that stay away
// from the brick. With those, triangles are closed, and wrap all samples as often that no triangle and no curtain is
// between.
//
//     rim  o-----o       p -> q crosses a curtain: their whole numbers differ
//          |  p  |  q
//          |     |       curtains
#pragma once

#include <array>

#include "bakers/rims.h"
#include "bakers/sample_links.h"

namespace brickfield {

class RimTurns {
public:
  /// first     the lowest sample of the brick, in soup space
  /// spacing   of samples
  /// cost      3 us and 1 us a rim edge that is near
  /// proved by tests/bake/bakers/rim_turns_test.cpp
  RimTurns(const Rims& rims, glm::dvec3 first, double spacing);

  /// False where so many edges are near that it would cost more than it saves; nothing else is of use then.
  bool areMeasured() const { return areMeasured_; }
  /// What rims and their surfaces make of it at a sample: off by a whole number. The slack is infinite where floats
  /// cannot tell.
  NearlyTurns at(std::size_t sample) const {
    return {static_cast<double>(turns_[sample]), static_cast<double>(slacks_[sample])};
  }
  /// Samples of which it is known to a quarter.
  SampleMask known() const { return samplesBelow(slacks_.data(), 0.25f); }
  /// Takes out the links that may cross a curtain.
  void cut(SampleLinks& links) const;

  /// Where a loop goes on, in voxels from the lowest sample; loops end with their first corner once more.
  struct Corner {
    glm::vec3 point;
    bool isLast;
  };

private:
  static constexpr std::size_t kMostEdges = 96; // beyond, few questions by parts of the brick cost less

  bool gather(const Rims::Loop& loop, const Rims& rims, glm::dvec3 first, double spacing);

  bool areMeasured_ = true;
  std::array<Corner, 2 * kMostEdges> corners_;
  std::size_t cornerCount_ = 0;
  std::array<float, kBrickSampleCount> turns_, slacks_;
};

} // namespace brickfield
