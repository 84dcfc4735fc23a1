// The Utah teapot: 32 bicubic Bézier patches, Martin Newell 1975 (the bottom was added later by Frank Crow), in the
// proportions that Jim Blinn made usual (height 3.15, not 4.1). The data are in the public domain.
#pragma once

#include <array>
#include <vector>

#include "scenes/shape.h"

namespace brickfield::scenes {

enum class TeapotPart { Rim, BodyUpper, BodyLower, Handle, Spout, LidKnob, Lid, Bottom };

/// Control points in the published axes: +Z up, spout along +X. Rows run along the profile (downwards, away from the
/// body, out from the axis), columns around it.
struct BezierPatch {
  TeapotPart part;
  int quarter = 0; ///< which patch around: 0 to 3 on bodies of revolution, 0 or 1 on handle and spout
  int segment = 0; ///< which patch along handle and spout
  std::array<std::array<glm::vec3, 4>, 4> rows;
};

/// All 32 patches.
std::vector<BezierPatch> teapotPatches();

/// A point of a patch, u across the columns, v along the rows; and the two derivatives.
struct PatchPoint {
  glm::vec3 position;
  glm::vec3 alongU;
  glm::vec3 alongV;
};
PatchPoint evaluatePatch(const BezierPatch& patch, float u, float v);

/// Rows of the teapot's texture that each part covers; u goes around, v along the profile. What a glaze is painted by.
glm::vec2 teapotTextureRows(TeapotPart part);

/// The teapot, +Y up, standing on y = 0, spout along +X, in the units of the data (length 6.43).
///
/// Three closed shells that cut each other: the body with its lid, the spout, the handle. What the patches leave open
/// is capped: the gap between rim and lid, the mouth of the spout (inside its lip) and the ends hidden in the body.
/// cellsPerPatch  squares along each side of a patch
/// proved by      tests/unit/scenes/demo_scenes_test.cpp
Shape teapotShape(int cellsPerPatch);

} // namespace brickfield::scenes
