// Inside or outside by counting how many triangles a ray crosses, along each axis, by majority. Shared edges and
// corners are counted once, by the half-open rule of scan conversion on welded vertices, whatever the ray hits.
#pragma once

#include "bakers/mesh_hierarchy.h"

namespace brickfield {

/// hierarchy over the triangles that bound the solid
/// point     soup space
/// returns   true where at least two of the three rays towards +x, +y, +z cross an odd number of triangles
/// proved by tests/bake/bakers/inside_test_test.cpp
bool isInsideByParity(const MeshHierarchy& hierarchy, glm::dvec3 point);

} // namespace brickfield
