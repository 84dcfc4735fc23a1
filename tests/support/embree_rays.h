// Embree over loose triangles: the oracle of rays and of distances.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "shared/world_field_params.h"

namespace brickfield::test {

struct OracleHit {
  float distance = 0; ///< infinite for none
  std::uint32_t triangle = 0;
  bool isFront = false;
};

class EmbreeRays {
public:
  /// Rows that are marked empty are left out.
  explicit EmbreeRays(std::span<const shared::WorldTriangle> rows);
  ~EmbreeRays();
  EmbreeRays(const EmbreeRays&) = delete;
  EmbreeRays& operator=(const EmbreeRays&) = delete;

  /// Watertight; both sides of triangles are hit.
  OracleHit trace(glm::vec3 origin, glm::vec3 direction) const;
  /// Unsigned distance to the nearest triangle, infinite without one.
  float distance(glm::vec3 point) const;

private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

} // namespace brickfield::test
