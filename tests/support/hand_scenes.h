// Small scenes built by hand, without files: what render tests need and no data file offers.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace brickfield::test {

/// Closed meshes of unit-like size around the origin, with smooth normals.
Mesh makeTorusMesh(float majorRadius, float minorRadius, int segments, int sides);
Mesh makeSphereMesh(float radius, int rings, int segments);
Mesh makeBoxMesh(glm::vec3 halfExtent);

/// A scene with one mesh and one node, named as the mesh.
Scene makeTorusAlone();
Scene makeTransformedTorus(const glm::mat4& worldFromObject);
/// One node without a name, a box of one metre of that material.
Scene makeBoxAlone(Material material, const glm::mat4& worldFromObject);
/// Node "Sphere", which pierces node "Torus".
Scene makeInterpenetration();
/// Forty spheres, boxes and tori that overlap in all ways; every second one is named "Sdf...".
Scene makeCrowd();

/// Six square sheets of one metre in two rows of three at z = 0, to be looked at from +Z, centred on the origin and 1.2
/// m apart. Upper row: "Front" faces +Z, "Back" faces -Z, "Mirrored" is Front in a node of scale (-1, 1, 1). Lower row:
/// "TurnedOver" is Front in a node of scale (1, 1, -1), "Masked" is double-sided and "MaskedFront" single-sided, both
/// cut by a mask: a round hole of 0.6 m, and a corner at (+x, +y) where there is nothing.
Scene makeSheets();

struct AffineCase {
  std::string name;
  glm::mat4 worldFromObject;
};
std::vector<AffineCase> affineCases();

} // namespace brickfield::test
