// OpenVDB's meshToVolume, for measures beside our own baker. A build finds the library or does without it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/math.h"

namespace brickfield {

struct PeerMesh {
  std::vector<glm::vec3> positionsVoxels; ///< in voxels, as meshToVolume wants them
  std::vector<glm::uvec3> triangles;
};

/// What meshToVolume is to tell: distances with sides, or none. Of open meshes it has inside what its own voxels happen
/// to shut in.
enum class PeerSides { Told, NotTold };

struct PeerBand {
  std::shared_ptr<const void> grid; ///< its own, kept so that freeing it is no part of a measure
};

bool isBuiltWithOpenVdb();

/// Distances of up to three voxels from the surface, on so many threads.
///
/// error    Failure: not built with OpenVDB
PeerBand bandByOpenVdb(const PeerMesh& mesh, PeerSides sides, int threads);

struct PeerVoxels {
  std::uint64_t active = 0, inside = 0; ///< inside: of the active ones
};
PeerVoxels countVoxels(const PeerBand& band);

} // namespace brickfield
