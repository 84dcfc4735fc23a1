// The baker: triangles of a scene to a BrickField. Exact distances by a traversal over a hierarchy that Embree builds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "field/brick_field.h"
#include "scene/pose.h"

namespace brickfield {

/// How inside and outside are told apart:
///   Auto          closed components are solid, inside out or not; open ones that nearly close as well, where they wrap
///                 a point by at least half (membranes close holes); other open ones are sheets as a whole
///   Winding       inside where the winding number of all triangles is at least one half, of either sign; no sheets
///   Parity        inside where rays cross an odd number of triangles; no sheets
///   Pseudonormal  by the closest feature's normal; closed manifolds only
///   TwoSided      everything is a sheet
/// A sheet is the slab of points up to half a thickness away, at least 0.5625 voxel of its level: thinner, it could
/// fall between two samples (0.525 where a mask cuts it: just enough). Where no thickness is asked for and its front
/// can be told, the slab of Auto lies behind the front instead, 1.755 voxels deep (sheet_slabs.h). Masked sheets are
/// cut along their masks; those of single-sided materials cover their front alone. Closed solids of Auto that are
/// thinner than 1.755 voxels of a level are drawn up to 1.125 voxels thicker, both sides alike, where more than 1 % of
/// a mesh is thinner than a voxel (thin_parts.h).
struct BakeSettings {
  int resolution = 128; ///< voxels along the longest side of the surface's box, sheets' thickness included; 8 to 1024
  int bits = 8;         ///< 8 or 16
  int mips = 3;         ///< levels, 1 to 4; fewer where a level would have less than one brick
  SignMethod sign = SignMethod::Auto;
  float thickness = 0; ///< of sheets, metres of object space; 0: as thin as can be shown, 1.125 voxels
  bool attributes = true;
  /// What a bake may take of memory; decides no bytes, so it is no part of the hash. 0: what a field may have, 8 GiB.
  std::uint64_t memoryBytes = 0;
  int threads = 0; ///< 0: all
};

inline constexpr int kMostResolution = 1024;

/// What is baked: the primitives of one mesh as they stand in object space (deformed ones: as posed).
struct BakeInput {
  std::string label; ///< for messages and progress
  const Scene* scene = nullptr;
  std::vector<const Primitive*> primitives;
  std::vector<std::vector<glm::vec3>> positionsObject; ///< one array a primitive
  /// Of a flat double-sided mesh at the border of its scene, as floors are: the side of it on which the scene lies and
  /// from which it is looked at. Unit; zero: not known.
  glm::vec3 seenFromObject{0};
};

/// A mesh counts as flat where so much of its area is left when area vectors are added up.
inline constexpr double kFlatShare = 0.95;

/// The mesh of a posed instance in its object space.
BakeInput bakeInputOf(const Scene& scene, const PosedInstance& instance);
/// The same with seenFromObject, by everything in the pose that the instance belongs to.
///
/// cost      of flat double-sided meshes: a look at every vertex of the pose's meshes
/// proved by tests/bake/bakers/scene_side_test.cpp
BakeInput bakeInputOf(const Scene& scene, const PosedInstance& instance, const Pose& pose);

/// Wall-clock seconds of a bake by what they went to.
struct BakeSeconds {
  double gather = 0;     ///< weld, topology, what is solid and what is a sheet
  double hierarchy = 0;  ///< built over the triangles
  double distance = 0;   ///< cells, then samples
  double sign = 0;       ///< winding numbers' moments, flood, inside tests, thin parts
  double attributes = 0; ///< of the surface
  double packing = 0;    ///< codes and indirection
};

struct BakeStats {
  std::uint64_t triangles = 0;
  std::uint64_t degenerateTriangles = 0;
  std::uint64_t openEdges = 0;
  std::uint64_t nonManifoldEdges = 0;
  std::uint64_t sheetTriangles = 0; ///< triangles with open space on both sides, thickened
  std::string sign;         ///< how the sign was decided; "cached" where only bricks, bytes and seconds are known
  std::uint64_t bricks = 0; ///< of all levels
  std::uint64_t bytes = 0;
  double seconds = 0;
  BakeSeconds stages;
  std::uint64_t hierarchyBytes = 0; ///< with what winding numbers add to it
  std::uint64_t queries = 0;        ///< points whose distance to a surface was asked for, all levels
};

struct BakeResult {
  BrickField field;
  BakeStats stats;
  std::string cacheWarning; ///< by bakeCached: the entry that could not be read or the folder that holds no cache
};

/// Bakes all levels.
///
/// progress  stages by level, in bricks
/// returns   the same bytes on any number of threads
/// error     BadInput that names input.label: no triangle of positive area, nothing left by its mask, indices out of
/// range,
///           positions that are not finite or too far from the origin, a level that needs more than memoryBytes (with
///           the number, before it is made), Pseudonormal on what is no closed manifold; BadInput that names the
///           setting: out of range; Cancelled
/// cost      on one core about 1 us a sample near the surface; an open mesh up to three times that
/// proved by tests/bake/bakers
BakeResult bakeField(const BakeInput& input, const BakeSettings& settings, const Progress& progress = {});

/// Hash of all that decides the bytes of a bake: geometry, materials and textures used, settings, baker version.
Hash128 bakeHash(const BakeInput& input, const BakeSettings& settings);

/// Reads OUT of the cache folder by content hash or bakes and stores it there. An entry that cannot be read (damaged,
/// no regular file, no permission) is baked anew; nothing waits for it. Safe against several processes at once.
///
/// cacheFolder empty: no cache; made if missing; one that cannot be written caches nothing
/// returns     with cacheWarning where the cache was no help
/// error       as bakeField; never because of the cache
/// proved by   tests/bake/bakers/bake_cache_test.cpp
BakeResult bakeCached(const BakeInput& input, const BakeSettings& settings, const std::filesystem::path& cacheFolder,
                      const Progress& progress = {}, bool* wasCached = nullptr);

/// $XDG_CACHE_HOME/brickfield or $HOME/.cache/brickfield; empty where neither is set.
std::filesystem::path defaultCacheFolder();

} // namespace brickfield
