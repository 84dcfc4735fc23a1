// Flattens SurfaceTopology into the rows of shaders/shared/world_triangles_params.h.
#include "resident/topology_table.h"

#include "core/error.h"
#include "scene/surface_topology.h"
#include "shared/world_field_params.h"

namespace brickfield {

namespace {

static_assert(SurfaceTopology::kNone == shared::NO_NEIGHBOUR);

// Fan corners number a triangle and its corner in 32 bits, with a bit to spare.
constexpr std::size_t kMostRows = std::size_t{1} << 28;

void appendRow(const SurfaceTopology& topology, std::size_t triangle, std::uint32_t firstVertex,
               const std::uint32_t* vertices, std::vector<shared::TopologyRow>& rows) {
  const std::uint32_t flags = (topology.isDegenerate[triangle] ? shared::WORLD_TRIANGLE_EMPTY : 0u) |
                              (topology.isClosed(triangle) ? shared::WORLD_TRIANGLE_CLOSED : 0u);
  const auto& beyond = topology.neighbours[triangle];
  rows.push_back({{firstVertex + vertices[0], firstVertex + vertices[1], firstVertex + vertices[2], flags},
                  {beyond[0], beyond[1], beyond[2], 0}});
}

void appendRows(const Scene& scene, const MeshPool& pool, int mesh, const SurfaceTopology& topology,
                std::vector<shared::TopologyRow>& rows) {
  const auto& primitives = scene.meshes[static_cast<std::size_t>(mesh)].primitives;
  std::size_t triangle = 0;
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const std::uint32_t firstVertex = pool.primitive(mesh, p).firstVertex;
    const std::vector<std::uint32_t>& indices = primitives[p].indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3, ++triangle)
      appendRow(topology, triangle, firstVertex, &indices[i], rows);
  }
  for (const SurfaceTopology::Cap& cap : topology.caps)
    appendRow(topology, triangle++, pool.primitive(mesh, cap.primitive).firstVertex, cap.vertices.data(), rows);
}

// Of closed surfaces alone: sheets have no sides, so nobody asks for their pseudonormals. A fan's triangles hang
// together by their edges, so one tells of all. returns how many
std::uint32_t appendClosedFans(const SurfaceTopology& topology, std::vector<std::uint32_t>& starts,
                               std::vector<std::uint32_t>& corners) {
  std::uint32_t count = 0;
  for (std::uint32_t vertex = 0; vertex < topology.vertexCount; ++vertex) {
    const auto first = topology.fanCorners.begin() + topology.fanStarts[vertex];
    const auto last = topology.fanCorners.begin() + topology.fanStarts[vertex + 1];
    if (first == last || !topology.isClosed(*first >> 2)) continue;
    starts.push_back(static_cast<std::uint32_t>(corners.size()));
    corners.insert(corners.end(), first, last);
    ++count;
  }
  starts.push_back(static_cast<std::uint32_t>(corners.size()));
  return count;
}

} // namespace

TopologyTable::TopologyTable(const Scene& scene, const MeshPool& pool, const std::vector<bool>& isUsed,
                             SmallHoles holes)
    : meshes_(scene.meshes.size()) {
  std::vector<shared::TopologyRow> rows;
  std::vector<std::uint32_t> starts, corners;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    if (!isUsed[m]) continue;
    const SurfaceTopology topology = analyseSurface(scene.meshes[m], holes);
    if (rows.size() + topology.triangleCount() > kMostRows)
      throw Failure("world field: the scene's meshes have more than 2^28 triangles");
    meshes_[m] = {static_cast<std::uint32_t>(rows.size()), static_cast<std::uint32_t>(topology.triangleCount()),
                  static_cast<std::uint32_t>(starts.size()), 0,
                  std::vector<std::uint32_t>(scene.meshes[m].primitives.size(), 0)};
    for (const SurfaceTopology::Cap& cap : topology.caps) ++meshes_[m].capsOfPrimitive[cap.primitive];
    meshes_[m].vertexCount = appendClosedFans(topology, starts, corners);
    appendRows(scene, pool, static_cast<int>(m), topology, rows);
  }
  triangles_ = Buffer("world_topology", rows);
  fanStarts_ = Buffer("world_fan_starts", starts);
  fanCorners_ = Buffer("world_fan_corners", corners);
}

} // namespace brickfield
