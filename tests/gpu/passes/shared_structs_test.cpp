// What the driver makes of the structs of shaders/shared, in the layouts that the passes use, equals what the compiler
// makes of them.
#include <cstddef>

#include "shared/frame_params.h"
#include "shared/mesh_params.h"
#include "shared/node_look_params.h"
#include "shared/sdf_params.h"
#include "shared/shadow_map_params.h"
#include "shared/triangle_hierarchy_params.h"
#include "shared/world_field_params.h"
#include "shared/world_triangles_params.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

using Offsets = std::map<std::string, int, std::less<>>;

// Name and offset of a member, as GL gives an array its first element's.
#define MEMBER(type, member)                                                                                           \
  { #member, static_cast < int>(offsetof(shared::type, member)) }
#define ARRAY(type, member)                                                                                            \
  { #member "[0]", static_cast < int>(offsetof(shared::type, member)) }

class SharedStructs : public GlTest {
protected:
  // As the element of a std430 array of structs.
  void expectRows(const std::string& type, const std::string& header, std::size_t bytes, const Offsets& members) {
    const auto program = bench_.loadWhole("#include \"shared/" + header + "\"\n" + R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer RowBlock { )" +
                                          type + R"( rows[]; };
layout(std430, binding = 1) writeonly buffer CopyBlock { )" +
                                          type + R"( copies[]; };
void main() { copies[gl_GlobalInvocationID.x] = rows[gl_GlobalInvocationID.x]; })");
    const Program::BlockLayout layout = program->blockLayout("RowBlock", true);
    Offsets expected;
    for (const auto& [name, offset] : members) expected["rows[0]." + name] = offset;
    EXPECT_EQ(layout.offsets, expected) << type;
    EXPECT_EQ(layout.arrayStride, static_cast<int>(bytes)) << type;
  }

  ShaderBench bench_;
};

TEST_F(SharedStructs, FrameParamsAsUniformBlock) {
  const auto program = bench_.loadWhole(R"(
#include "lib/frame.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 0) writeonly buffer CopyBlock { FrameParams copy; };
void main() { copy = frame; })");
  const Offsets members{
      MEMBER(FrameParams, clipFromEye),         MEMBER(FrameParams, worldFromView), MEMBER(FrameParams, eyeWorld),
      MEMBER(FrameParams, projection),          MEMBER(FrameParams, size),          MEMBER(FrameParams, counts),
      MEMBER(FrameParams, debugRange),          MEMBER(FrameParams, eyeAnchored),   ARRAY(FrameParams, irradiance),
      MEMBER(FrameParams, previousClipFromEye), MEMBER(FrameParams, jitter)};
  for (const bool storage : {false, true}) {
    const Program::BlockLayout layout = program->blockLayout(storage ? "CopyBlock" : "FrameBlock", storage);
    Offsets expected;
    for (const auto& [name, offset] : members) expected[(storage ? "copy." : "frame.") + name] = offset;
    EXPECT_EQ(layout.offsets, expected);
    EXPECT_EQ(layout.bytes, static_cast<int>(sizeof(shared::FrameParams)));
  }
}

TEST_F(SharedStructs, RowsOfLightsAndMeshes) {
  expectRows(
      "LightRow", "frame_params.h", sizeof(shared::LightRow),
      {MEMBER(LightRow, position), MEMBER(LightRow, direction), MEMBER(LightRow, intensity), MEMBER(LightRow, cone)});
  expectRows("MeshVertex", "mesh_params.h", sizeof(shared::MeshVertex),
             {MEMBER(MeshVertex, position), MEMBER(MeshVertex, uv), MEMBER(MeshVertex, codes)});
  expectRows("MeshDraw", "mesh_params.h", sizeof(shared::MeshDraw),
             {MEMBER(MeshDraw, worldFromObject), MEMBER(MeshDraw, ids)});
  expectRows("MaterialRow", "mesh_params.h", sizeof(shared::MaterialRow),
             {MEMBER(MaterialRow, baseColor), MEMBER(MaterialRow, emission), MEMBER(MaterialRow, factors),
              MEMBER(MaterialRow, flags), ARRAY(MaterialRow, textureFromUv)});
  expectRows("MeshMotion", "mesh_params.h", sizeof(shared::MeshMotion),
             {MEMBER(MeshMotion, previousWorldFromObject), MEMBER(MeshMotion, vertices)});
  expectRows("DeformParams", "mesh_params.h", sizeof(shared::DeformParams),
             {MEMBER(DeformParams, vertices), MEMBER(DeformParams, sources), MEMBER(DeformParams, weights)});
}

TEST_F(SharedStructs, RowsOfSdfObjects) {
  expectRows("SdfInstance", "sdf_params.h", sizeof(shared::SdfInstance),
             {ARRAY(SdfInstance, gridFromWorld), ARRAY(SdfInstance, worldFromGrid), MEMBER(SdfInstance, boxMin),
              MEMBER(SdfInstance, boxMax), MEMBER(SdfInstance, ids)});
  expectRows("SdfMotion", "sdf_params.h", sizeof(shared::SdfMotion), {ARRAY(SdfMotion, previousWorldFromGrid)});
  expectRows("SdfLook", "sdf_params.h", sizeof(shared::SdfLook),
             {MEMBER(SdfLook, objectFromGrid), MEMBER(SdfLook, texturing), MEMBER(SdfLook, transmission),
              MEMBER(SdfLook, absorption)});
  expectRows("SdfLevel", "sdf_params.h", sizeof(shared::SdfLevel),
             {MEMBER(SdfLevel, cells), MEMBER(SdfLevel, scale), MEMBER(SdfLevel, attributes)});
  expectRows("BoxCommand", "sdf_params.h", sizeof(shared::BoxCommand),
             {MEMBER(BoxCommand, vertices), MEMBER(BoxCommand, instances), MEMBER(BoxCommand, firstVertex),
              MEMBER(BoxCommand, baseInstance)});
}

TEST_F(SharedStructs, LooksOfNodes) {
  expectRows("NodeLook", "node_look_params.h", sizeof(shared::NodeLook),
             {MEMBER(NodeLook, baseColor), MEMBER(NodeLook, emission)});
}

TEST_F(SharedStructs, RowsOfTheWorldField) {
  expectRows(
      "WorldTriangle", "world_field_params.h", sizeof(shared::WorldTriangle),
      {MEMBER(WorldTriangle, a), MEMBER(WorldTriangle, b), MEMBER(WorldTriangle, c), MEMBER(WorldTriangle, codes)});
  expectRows(
      "WorldInstance", "world_field_params.h", sizeof(shared::WorldInstance),
      {MEMBER(WorldInstance, anchoredFromObject), MEMBER(WorldInstance, triangles), MEMBER(WorldInstance, vertices)});
  expectRows("FieldCascade", "world_field_params.h", sizeof(shared::FieldCascade),
             {MEMBER(FieldCascade, window), MEMBER(FieldCascade, texel), MEMBER(FieldCascade, buffers),
              MEMBER(FieldCascade, extent)});
  expectRows("TopologyRow", "world_triangles_params.h", sizeof(shared::TopologyRow),
             {MEMBER(TopologyRow, corners), MEMBER(TopologyRow, neighbours)});
  expectRows("GatherChunk", "world_triangles_params.h", sizeof(shared::GatherChunk),
             {MEMBER(GatherChunk, instance), MEMBER(GatherChunk, first), MEMBER(GatherChunk, count),
              MEMBER(GatherChunk, vertexOffset)});
}

TEST_F(SharedStructs, RowsOfShadowMaps) {
  expectRows("ShadowMapLayer", "shadow_map_params.h", sizeof(shared::ShadowMapLayer),
             {MEMBER(ShadowMapLayer, clipFromEye), MEMBER(ShadowMapLayer, eyeFromClip),
              MEMBER(ShadowMapLayer, eyeWorld), MEMBER(ShadowMapLayer, depth)});
  expectRows("ShadowMapLight", "shadow_map_params.h", sizeof(shared::ShadowMapLight), {MEMBER(ShadowMapLight, layers)});
}

TEST_F(SharedStructs, RowsOfTheTriangleHierarchy) {
  expectRows(
      "HierarchyNode", "triangle_hierarchy_params.h", sizeof(shared::HierarchyNode),
      {MEMBER(HierarchyNode, x), MEMBER(HierarchyNode, y), MEMBER(HierarchyNode, z), MEMBER(HierarchyNode, children)});
  expectRows("RefitRow", "triangle_hierarchy_params.h", sizeof(shared::RefitRow), {MEMBER(RefitRow, nodes)});
}

// Values travel: a struct filled here is read member by member there.
TEST_F(SharedStructs, ValuesArriveInTheirMembers) {
  const auto program = bench_.loadWhole(R"(
#include "shared/mesh_params.h"
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer RowBlock { MaterialRow rows[]; };
layout(std430, binding = 1) writeonly buffer ResultBlock { vec4 results[]; };
void main() {
  results[0] = rows[1].emission;
  results[1] = vec4(rows[1].flags);
  results[2] = rows[1].textureFromUv[9];
})");
  std::vector<shared::MaterialRow> rows(2);
  rows[1].emission = {1, 2, 3, 4};
  rows[1].flags = {5, 6, 7, -8};
  rows[1].textureFromUv[9] = {9, 10, 11, 12};
  const Buffer in("rows", rows), out("results", 3 * sizeof(glm::vec4));
  in.bindStorage(0);
  out.bindStorage(1);
  program->dispatchOver({1, 1, 1});
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const auto results = out.read<glm::vec4>();
  EXPECT_EQ(results[0], rows[1].emission);
  EXPECT_EQ(results[1], glm::vec4(rows[1].flags));
  EXPECT_EQ(results[2], rows[1].textureFromUv[9]);
}

} // namespace
} // namespace brickfield::test
