// The views that shadow maps are drawn from: cascades for suns, one view for spots, six for lights that shine all
// round. Cascades after Engel (2006, "Cascaded Shadow Maps"): parts of the camera's depth, each in a square of its own.
// They are held still: a square's size depends on the lens alone, and it moves by whole texels.
#pragma once

#include <vector>

#include "scene/pose.h"
#include "scene/view.h"

namespace brickfield {

inline constexpr int kSunCascades = 4;
inline constexpr int kCubeFaces = 6;
/// What filters may read beside a point, texels: the wide blur's seven, one for interpolation and one of snapping.
inline constexpr int kShadowMarginTexels = 9;
inline constexpr int kLeastShadowTexels = 64, kMostShadowTexels = 8192;

/// How a light's maps are laid out.
enum class ShadowLayout { Cascades, Spot, Cube };
ShadowLayout shadowLayoutOf(const Light& light);

struct ShadowView {
  View view;             ///< square; a sun's is parallel, its near plane above and its far plane below all of the scene
  float farDistance = 0; ///< metres from the eye along the view to the farthest of the scene
  float texelSpan = 0;   ///< metres a texel, of perspective views at one metre from the eye
  bool holdsScene = false; ///< a sun's, whose square holds everything
};

/// Where the camera's depth is cut: 0, then the ends of the cascades. Between the nearest and the farthest of the
/// scene, both rounded outwards to powers of the fourth root of two so that the cuts stay while the camera moves a
/// little.
std::vector<double> cascadeEnds(const View& camera, const Box& boundsWorld);

/// boundsWorld  of all casters and receivers; not empty
/// texels       of a map's side, at least kLeastShadowTexels
/// returns      kSunCascades views for a sun, near to far, one for a spot, kCubeFaces for others: +x -x +y -y +z -z
/// proved by    tests/unit/scene/shadow_views_test.cpp
std::vector<ShadowView> makeShadowViews(const PosedLight& light, const View& camera, const Box& boundsWorld,
                                        int texels);

} // namespace brickfield
