// Names of the resources, for messages and --list passes.
#include "passes/pass.h"

namespace brickfield {

const char* resourceName(Resource resource) {
  switch (resource) {
  case Resource::FrameParams:
    return "frame_params";
  case Resource::MeshVertices:
    return "mesh_vertices";
  case Resource::MeshDraws:
    return "mesh_draws";
  case Resource::SdfScene:
    return "sdf_scene";
  case Resource::VisibleBoxes:
    return "visible_boxes";
  case Resource::ScreenBoxes:
    return "screen_boxes";
  case Resource::Environment:
    return "environment";
  case Resource::Depth:
    return "depth";
  case Resource::DepthMesh:
    return "depth_mesh";
  case Resource::GBuffer:
    return "gbuffer";
  case Resource::BoxOverdraw:
    return "box_overdraw";
  case Resource::Shadow:
    return "shadow";
  case Resource::ShadowReads:
    return "shadow_reads";
  case Resource::ShadowMap:
    return "shadow_map";
  case Resource::ShadowMoments:
    return "shadow_moments";
  case Resource::ShadowRange:
    return "shadow_range";
  case Resource::OcclusionTraced:
    return "occlusion_traced";
  case Resource::Occlusion:
    return "occlusion";
  case Resource::Translucency:
    return "translucency";
  case Resource::ReflectionList:
    return "reflection_list";
  case Resource::ReflectionHit:
    return "reflection_hit";
  case Resource::Reflection:
    return "reflection";
  case Resource::Color:
    return "color";
  case Resource::Motion:
    return "motion";
  case Resource::History:
    return "history";
  case Resource::Picture:
    return "picture";
  case Resource::Counters:
    return "counters";
  case Resource::WorldTriangles:
    return "world_triangles";
  case Resource::Pseudonormals:
    return "pseudonormals";
  case Resource::TriangleHierarchy:
    return "triangle_hierarchy";
  case Resource::FieldKeys:
    return "field_keys";
  case Resource::FieldCandidates:
    return "field_candidates";
  case Resource::WorldFieldSeeds:
    return "world_field_seeds";
  case Resource::WorldFieldCoarse:
    return "world_field_coarse";
  case Resource::WorldField:
    return "world_field";
  }
  return "unknown";
}

} // namespace brickfield
