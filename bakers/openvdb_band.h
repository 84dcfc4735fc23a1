// OpenVDB's meshToVolume, for measures beside our own baker. A build finds the library or does without it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace brickfield {

struct PeerMesh {
  std::vector<glm::vec3> positionsVoxels; ///< in voxels, as meshToVolume wants them
  std::vector<glm::uvec3> triangles;
};

bool isBuiltWithOpenVdb();

/// A level set of three voxels to each side, on so many threads.
///
/// returns  active voxels
/// error    Failure: not built with OpenVDB
std::uint64_t bandByOpenVdb(const PeerMesh& mesh, int threads);

} // namespace brickfield
