// Generated shapes: bodies of revolution, swept tubes, boxes, gears, and a mesher for implicit surfaces. All have
// normals and, but for the implicit ones, texture coordinates; closed ones are closed to the last bit (equal positions
// at every seam). Metres, +Y up.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "scenes/shape.h"

namespace brickfield::scenes {

/// A corner of a profile in the half plane (radius, y) and the radius that it is rounded with.
struct ProfileCorner {
  glm::vec2 point;
  float rounding = 0;
};

/// The polyline through the corners with each rounded by an arc-like curve of `steps` pieces.
std::vector<glm::vec2> roundedProfile(std::span<const ProfileCorner> corners, int steps, bool closed);

/// Turns a profile about +Y. Points of radius 0 at the ends of an open profile become poles. u goes around, v is the
/// share of the profile's length. The result faces outward where it is closed.
Shape revolvedShape(std::span<const glm::vec2> profile, bool closedProfile, int segments);

struct TubeSettings {
  int steps = 128;    ///< along the curve
  int sides = 24;     ///< around it
  bool closed = true; ///< the curve ends where it starts; else both ends are capped by fans
};

/// Sweeps a section along a curve. The section lies in the plane across the curve; its first axis is `sideways` made
/// perpendicular. `radius` may depend on the place along (0 to 1) and around (radians).
Shape tubeShape(const TubeSettings& settings, const std::function<glm::vec3(float along)>& curve,
                const std::function<glm::vec3(float along)>& sideways,
                const std::function<float(float along, float aroundRadians)>& radius);

Shape sphereShape(float radius, int segments, int rings);
/// Axis +Y.
Shape torusShape(float ringRadius, float tubeRadius, int steps, int sides);
/// A (2,3) torus knot, axis +Y, with `ribs` turns of a soft ribbing around the tube.
Shape trefoilShape(float ringRadius, float tubeRadius, int steps, int sides, float ribDepth);
/// |x/a|^(2/e) ... = 1 as Barr 1981 writes it with one exponent; 1 is an ellipsoid, 0.2 a rounded box.
Shape superellipsoidShape(glm::vec3 halfExtent, float exponent, int segments);
/// Box whose edges are rounded; the texture covers each face once.
Shape roundedBoxShape(glm::vec3 halfExtent, float rounding, int steps);
/// Upright cylinder with rounded edges from y = 0 to y = height.
Shape podiumShape(float radius, float height, float rounding, int segments);

struct GearSettings {
  int teeth = 14;
  float rootRadius = 0.8f;
  float tipRadius = 1.0f;
  float boreRadius = 0.3f;
  float halfThickness = 0.15f;
  float rounding = 0.05f;
};
/// Gear with trapezoidal rounded teeth and a recess between hub and rim; axis +Y.
Shape gearShape(const GearSettings& settings);

/// Surface of {field < 0} by a dual method (one vertex a crossed cell, one quadrilateral a crossed edge, as surface
/// nets: Gibson 1998), vertices moved onto the surface by Newton steps, normals from the gradient. No texture
/// coordinates.
///
/// field    continuous, positive in the outermost cells of the cube [-halfSide, halfSide]^3, its slope about 1
/// cells    along each side of the cube; a few more where this number gives no manifold mesh
/// error    Failure if none of the numbers does
Shape implicitShape(float halfSide, int cells, const std::function<float(glm::vec3)>& field);

/// A hollow ball with 32 round holes, on the corners and faces of an icosahedron, rims rounded.
/// thickness of the shell in metres, some cells at least
Shape porousBallShape(float radius, float thickness, int cells);

} // namespace brickfield::scenes
