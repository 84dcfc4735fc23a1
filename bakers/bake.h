// The baker: triangles of a scene to a BrickField. Exact distances by a traversal over a hierarchy that Embree builds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "field/brick_field.h"
#include "scene/pose.h"

namespace brickfield {

struct BakeSettings {
  int resolution = 128; ///< voxels along the longest side of the mesh's box, 8 to 1024
  int bits = 8;         ///< 8 or 16
  int mips = 3;         ///< levels, 1 to 4; fewer where a level would have less than one brick
  SignMethod sign = SignMethod::Auto;
  float thickness = 0; ///< metres of object space for two-sided sheets; 0: one voxel
  bool attributes = true;
  int threads = 0; ///< 0: all
};

/// What is baked: the primitives of one mesh as they stand in object space (deformed ones: as posed).
struct BakeInput {
  std::string label; ///< for messages and progress
  const Scene* scene = nullptr;
  std::vector<const Primitive*> primitives;
  std::vector<std::vector<glm::vec3>> positionsObject; ///< one array a primitive
};

/// The mesh of a posed instance in its object space.
BakeInput bakeInputOf(const Scene& scene, const PosedInstance& instance);

struct BakeStats {
  std::uint64_t triangles = 0;
  std::uint64_t degenerateTriangles = 0;
  std::uint64_t openEdges = 0;
  std::uint64_t nonManifoldEdges = 0;
  std::uint64_t sheetTriangles = 0; ///< triangles with open space on both sides, thickened
  std::string sign;                 ///< how the sign was decided
  std::uint64_t bricks = 0;         ///< of all levels
  std::uint64_t bytes = 0;
  double seconds = 0;
};

struct BakeResult {
  BrickField field;
  BakeStats stats;
};

/// error BadInput: no triangle of positive area; settings out of range; Cancelled
BakeResult bakeField(const BakeInput& input, const BakeSettings& settings, const Progress& progress = {});

/// Hash of all that decides the bytes of a bake: geometry, materials and textures used, settings, baker version.
Hash128 bakeHash(const BakeInput& input, const BakeSettings& settings);

/// Reads OUT of the cache folder by content hash or bakes and stores it there. A damaged entry is baked anew.
/// cacheFolder empty: no cache. Safe against several processes at once.
BakeResult bakeCached(const BakeInput& input, const BakeSettings& settings, const std::filesystem::path& cacheFolder,
                      const Progress& progress = {}, bool* wasCached = nullptr);

/// $XDG_CACHE_HOME/brickfield or $HOME/.cache/brickfield; empty where neither is set.
std::filesystem::path defaultCacheFolder();

} // namespace brickfield
