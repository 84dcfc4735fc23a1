// A plane cut through a field as a picture, to look at what a bake made. It writes no file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/brick_field.h"

namespace brickfield {

struct SliceCut {
  int axis = 0;           ///< 0 x, 1 y, 2 z: the plane's normal
  float position = 0.5f;  ///< along the axis
  bool isFraction = true; ///< position 0 to 1 through the bounds; otherwise metres of object space
  std::size_t level = 0;  ///< 0 is the finest
  int longerSidePixels = 512;
};

struct SliceImage {
  glm::ivec2 size{0};
  std::vector<std::uint8_t> rgb; ///< sRGB, 3 bytes a pixel, rows from the top
};

/// The bounds of the field cut by a plane: blue inside and orange outside, paler with distance, a darker line every
/// whole voxel, black on the surface. Grey stands for cells without a brick, where only a bound is known. Right is the
/// next axis in x y z x, up the one after it.
///
/// error      BadInput that names the setting: axis, level, picture size (1 to 16384), a plane beside the bounds
/// cost       one sample a pixel
/// proved by  tests/unit/field/slice_test.cpp
SliceImage cutField(const BrickField& field, const SliceCut& cut);

} // namespace brickfield
