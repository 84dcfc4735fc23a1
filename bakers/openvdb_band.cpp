#include "bakers/openvdb_band.h"

#include "core/error.h"

#ifdef BRICKFIELD_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/task_arena.h>
#endif

namespace brickfield {

#ifdef BRICKFIELD_OPENVDB

namespace {

constexpr float kHalfBandVoxels = 3.0f; // OpenVDB's own default

/// What meshToVolume asks of a mesh.
class MeshAdapter {
public:
  explicit MeshAdapter(const PeerMesh& mesh) : mesh_(mesh) {}
  std::size_t polygonCount() const { return mesh_.triangles.size(); }
  std::size_t pointCount() const { return mesh_.positionsVoxels.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t polygon, std::size_t corner, openvdb::Vec3d& point) const {
    const auto k = static_cast<glm::length_t>(corner);
    const glm::vec3 p = mesh_.positionsVoxels[mesh_.triangles[polygon][k]];
    point = openvdb::Vec3d(p.x, p.y, p.z);
  }

private:
  const PeerMesh& mesh_;
};

} // namespace

bool isBuiltWithOpenVdb() { return true; }

PeerBand bandByOpenVdb(const PeerMesh& mesh, PeerSides sides, int threads) {
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  const int flags = sides == PeerSides::Told ? 0 : openvdb::tools::UNSIGNED_DISTANCE_FIELD;
  openvdb::FloatGrid::Ptr grid;
  tbb::task_arena(threads).execute([&] {
    grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(MeshAdapter(mesh), *transform, kHalfBandVoxels,
                                                            kHalfBandVoxels, flags);
  });
  return {grid};
}

PeerVoxels countVoxels(const PeerBand& band) {
  const auto& grid = *static_cast<const openvdb::FloatGrid*>(band.grid.get());
  PeerVoxels voxels;
  voxels.active = grid.activeVoxelCount();
  for (auto value = grid.cbeginValueOn(); value; ++value) voxels.inside += *value < 0.0f;
  return voxels;
}

#else

bool isBuiltWithOpenVdb() { return false; }

PeerBand bandByOpenVdb(const PeerMesh&, PeerSides, int) { throw Failure("not built with OpenVDB"); }
PeerVoxels countVoxels(const PeerBand&) { return {}; }

#endif

} // namespace brickfield
