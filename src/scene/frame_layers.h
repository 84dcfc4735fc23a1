// The layers of one image on the CPU: what the renderer reads back, the reference traces and --layers writes.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/math.h"

namespace brickfield {

enum class SurfaceKind : std::uint8_t { None = 0, Mesh = 1, Sdf = 2 };

/// Rows from the top. Every vector is empty (layer not made) or width * height long.
struct FrameLayers {
  glm::uvec2 size{0};
  std::vector<glm::vec3> color;         ///< linear scene radiance, before exposure and tone curve
  std::vector<float> depth;             ///< metres along the view ray; infinity for sky
  std::vector<glm::vec3> normal;        ///< world, with normal maps; zero for sky
  std::vector<glm::vec3> normalSurface; ///< world, before normal maps, towards the viewer; zero for sky
  std::vector<glm::vec3> albedo;        ///< linear base colour
  std::vector<std::int32_t> id;         ///< node index; -1 for sky
  std::vector<SurfaceKind> kind;
  std::vector<std::vector<float>> shadow; ///< a light each: share of it that the surface sees; 1 for sky
  std::vector<float> ambientOcclusion;    ///< share of the hemisphere that is open, by the cosine; 1 for sky
  std::vector<float> thickness;           ///< metres of the SDF object along the view ray; 0 for meshes and sky
  std::vector<float>
      steps; ///< trace steps of SDF objects; 0 elsewhere and in the reference, which steps through nothing
};

} // namespace brickfield
