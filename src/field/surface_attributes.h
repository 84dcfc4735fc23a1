// Reading the surface attributes of a field on the CPU, as the shaders' filtered fetches do.
#pragma once

#include <optional>

#include "field/analytic.h"

namespace brickfield {

/// Attributes that one level stores around a point of the surface, interpolated in linear light.
///
/// pointObject  metres in object space, within two voxels of the surface, where they are exact
/// returns      nothing where the level has no attributes or no brick there
/// proved by    tests/unit/field/surface_attributes_test.cpp
std::optional<SurfaceAttributes> attributesAt(const BrickField& field, std::size_t level, glm::vec3 pointObject);

} // namespace brickfield
