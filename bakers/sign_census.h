// How a bake judged what is inside, told by a sample of its voxels: what --stats says of the sign. It decides nothing.
#pragma once

#include <cstdint>
#include <string>

#include "bakers/bake.h"

namespace brickfield {

/// Shares of the stored samples of the finest level; the first three add up to 1.
struct SignCensus {
  std::uint64_t samples = 0;
  double byClosed = 0; ///< nearest to a solid, where only a triangle could change the answer: certain
  double byOpen = 0;   ///< nearest to a solid, by the winding number of open triangles
  double bySheets = 0; ///< nearest to a sheet: a slab, no inside
  /// Of those by open triangles: how far their winding number is from one half, 1 where it is a whole number; the mean,
  /// the hundredth part that is least sure, and the share (of all samples) below one fifth.
  double meanSureness = 1, leastSureness = 1, doubtful = 0;
  /// Nearest to a solid, but stored with the other sign: slabs that cover it, membranes and thin parts drawn thicker.
  double overruled = 0;
};

/// field        of this input and these settings
/// mostSamples  at least 1
/// error        as bakeField
/// cost         gathers triangles and builds hierarchies anew, then two distances and a winding number a sample
/// proved by    tests/bake/bakers/sign_census_test.cpp
SignCensus takeSignCensus(const BakeInput& input, const BakeSettings& settings, const BrickField& field,
                          std::uint64_t mostSamples = 20000);

struct TriangleSoup;
struct BakeSurfaces;
class InsideTest;
/// The same for a bake's parts. inside  nothing where no triangle is solid
SignCensus countSigns(const TriangleSoup& soup, const BakeSurfaces& surfaces, const InsideTest* inside,
                      const BrickField& field, std::uint64_t mostSamples);

} // namespace brickfield
