// What a pass is to the frame plan: a name, what it reads, what it writes. From these the plan proves that nothing
// reads what nobody wrote, and derives the memory barriers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace brickfield {

/// Everything that one pass may leave for another. Names are those of the G-buffer's textures and the pools' buffers.
enum class Resource : std::uint8_t {
  FrameParams,
  MeshVertices,
  MeshDraws,
  SdfScene,     ///< instances, levels, indirection, atlas
  VisibleBoxes, ///< list and draw commands of the SDF objects
  ScreenBoxes,  ///< where they lie on the picture
  Environment,
  Depth,
  DepthMesh, ///< depth of the meshes alone, which ends the rays of SDF objects
  GBuffer,   ///< normal, albedo, material, emission, id, trace
  BoxOverdraw,
  Shadow,      ///< visible shares of lights
  ShadowReads, ///< what they cost
  ShadowMap,
  ShadowMoments,   ///< blurred, of the shadow maps
  ShadowRange,     ///< their nearest and farthest depths over squares
  OcclusionTraced, ///< open shares of the hemisphere at fewer pixels
  Occlusion,       ///< at all of them
  Translucency,    ///< light through SDF objects, and their thickness
  ReflectionList,  ///< pixels whose reflected rays are traced
  ReflectionHit,   ///< what these meet
  Reflection,      ///< how bright it is
  Color,
  Motion,  ///< motion vectors
  History, ///< pictures and depths averaged over frames
  Picture,
  Counters,
  WorldTriangles,    ///< triangles of all drawn instances where they stand
  Pseudonormals,     ///< in their rows
  TriangleHierarchy, ///< over them, for rays
  FieldKeys,         ///< of the exact field: surface keys and seeds
  FieldCandidates,   ///< nearest triangles at half resolution
  WorldFieldSeeds,   ///< of the flooding; both halves
  WorldFieldCoarse,  ///< unsigned, less the thickness
  WorldField,        ///< the volume that other passes read, and what it keeps from frame to frame
};
inline constexpr int kResourceCount = 35;
const char* resourceName(Resource resource);

/// How the GPU touches it: decides the barrier after incoherent writes.
enum class Access : std::uint8_t {
  Attachment, ///< colour or depth target, blit and copy
  Sampled,    ///< texture or image fetch of any stage
  ImageStore, ///< incoherent write
  StorageRead,
  StorageWrite, ///< incoherent write
  Uniform,
  VertexFetch,
  Indirect,
  Upload, ///< written by the host
};

struct ResourceUse {
  Resource resource;
  Access access;
};

/// A pass declares this once; it costs no GL.
struct PassDeclaration {
  std::string name;
  std::vector<ResourceUse> reads;
  std::vector<ResourceUse> writes;
  std::vector<ResourceUse> readsIfMade{}; ///< what some frames have and others do without
};

} // namespace brickfield
