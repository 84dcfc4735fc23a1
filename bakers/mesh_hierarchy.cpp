// Embree's builder calls back for nodes and leaves; the result is then copied into two arrays in depth-first order.
// The builder runs in an arena of one thread: its parallel partition would put equal triangles in varying order.
#include "bakers/mesh_hierarchy.h"

#include <algorithm>
#include <memory>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::size_t kAllocationAlignment = 16;

struct BuiltNode {
  std::uint32_t childCount = 0; ///< 0: a leaf
  std::uint32_t triangleCount = 0;
  std::array<BuiltNode*, kHierarchyWidth> children{};
  std::array<Box, kHierarchyWidth> boxes;
  std::array<std::uint32_t, kHierarchyWidth> triangles{};
};

void* createNode(RTCThreadLocalAllocator allocator, unsigned childCount, void*) {
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), kAllocationAlignment)) BuiltNode;
  node->childCount = childCount;
  return node;
}

void setChildren(void* nodePointer, void** children, unsigned childCount, void*) {
  for (unsigned i = 0; i < childCount; ++i)
    static_cast<BuiltNode*>(nodePointer)->children[i] = static_cast<BuiltNode*>(children[i]);
}

void setBounds(void* nodePointer, const RTCBounds** bounds, unsigned childCount, void*) {
  for (unsigned i = 0; i < childCount; ++i) {
    const RTCBounds& b = *bounds[i];
    static_cast<BuiltNode*>(nodePointer)->boxes[i] = {{b.lower_x, b.lower_y, b.lower_z},
                                                      {b.upper_x, b.upper_y, b.upper_z}};
  }
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*) {
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), kAllocationAlignment)) BuiltNode;
  leaf->triangleCount = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) leaf->triangles[i] = primitives[i].primID;
  std::sort(leaf->triangles.begin(), leaf->triangles.begin() + static_cast<std::ptrdiff_t>(count));
  return leaf;
}

RTCBuildPrimitive buildPrimitive(const TriangleSoup& soup, std::uint32_t triangle) {
  Box box;
  for (const glm::dvec3& corner : soup.corners(triangle)) box.extend(glm::vec3(corner));
  return {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, triangle};
}

HierarchyLeaf flattenLeaf(const TriangleSoup& soup, const BuiltNode& built) {
  HierarchyLeaf leaf;
  leaf.count = built.triangleCount;
  for (std::size_t i = 0; i < kHierarchyWidth; ++i) {
    const std::uint32_t triangle = built.triangles[std::min<std::size_t>(i, built.triangleCount - 1)];
    const auto [a, b, c] = soup.corners(triangle);
    leaf.triangles[i] = triangle;
    leaf.a.setLane(i, glm::vec3(a));
    leaf.ab.setLane(i, glm::vec3(b - a));
    leaf.ac.setLane(i, glm::vec3(c - a));
    leaf.normal.setLane(i, glm::vec3(glm::normalize(glm::cross(b - a, c - a))));
  }
  return leaf;
}

/// Copies the built tree depth first, so that what is walked together lies together.
class Flattener {
public:
  Flattener(const TriangleSoup& soup, std::vector<HierarchyNode>& nodes, std::vector<HierarchyLeaf>& leaves)
      : soup_(soup), nodes_(nodes), leaves_(leaves) {}

  HierarchyChild copy(const BuiltNode& built) {
    if (built.childCount == 0) {
      leaves_.push_back(flattenLeaf(soup_, built));
      return {HierarchyChild::kLeafBit | static_cast<std::uint32_t>(leaves_.size() - 1)};
    }
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    for (std::size_t i = 0; i < kHierarchyWidth; ++i) {
      const bool exists = i < built.childCount;
      const Box box = exists ? built.boxes[i] : Box{};
      nodes_[index].min.setLane(i, box.min);
      nodes_[index].max.setLane(i, box.max);
      if (!exists) continue;
      const HierarchyChild child = copy(*built.children[i]);
      nodes_[index].children[i] = child;
    }
    return {static_cast<std::uint32_t>(index)};
  }

private:
  const TriangleSoup& soup_;
  std::vector<HierarchyNode>& nodes_;
  std::vector<HierarchyLeaf>& leaves_;
};

} // namespace

MeshHierarchy::MeshHierarchy(const TriangleSoup& soup, std::vector<std::uint32_t> triangles) : soup_(&soup) {
  const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device(rtcNewDevice(nullptr), rtcReleaseDevice);
  if (!device) throw Failure("Embree: no device");
  const std::unique_ptr<RTCBVHTy, void (*)(RTCBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);

  std::vector<RTCBuildPrimitive> primitives(triangles.size());
  Box bounds;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const RTCBuildPrimitive& p = primitives[i] = buildPrimitive(soup, triangles[i]);
    bounds.extend(Box{{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}});
  }
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxBranchingFactor = kHierarchyWidth;
  arguments.sahBlockSize = kHierarchyWidth; // eight triangles cost as much as one
  arguments.maxLeafSize = kHierarchyWidth;
  arguments.minLeafSize = 1;
  arguments.maxDepth = 64;
  arguments.bvh = bvh.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = primitives.size();
  arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = createNode;
  arguments.setNodeChildren = setChildren;
  arguments.setNodeBounds = setBounds;
  arguments.createLeaf = createLeaf;
  const void* built = nullptr;
  tbb::task_arena(1).execute([&] { built = rtcBuildBVH(&arguments); });
  if (!built) throw Failure(fmt::format("Embree: no hierarchy over {} triangles", triangles.size()));

  BuiltNode top = *static_cast<const BuiltNode*>(built);
  if (top.childCount == 0) { // a lone leaf: give it a node, so that walks always start at one
    BuiltNode parent;
    parent.childCount = 1;
    parent.children[0] = &top;
    parent.boxes[0] = bounds;
    Flattener(soup, nodes_, leaves_).copy(parent);
  } else {
    Flattener(soup, nodes_, leaves_).copy(top);
  }
}

} // namespace brickfield
