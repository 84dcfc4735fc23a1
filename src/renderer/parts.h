// What the renderer owns: the passes, the scene on the GPU, what a frame leaves for the next. How a frame is listed.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "gpu/shader_library.h"
#include "passes/debug/debug_view_pass.h"
#include "passes/debug/field_view_pass.h"
#include "passes/debug/shadow_map_view_pass.h"
#include "passes/debug/taa_view_pass.h"
#include "passes/geometry/deform_pass.h"
#include "passes/geometry/mesh_pass.h"
#include "passes/geometry/sdf_box_pass.h"
#include "passes/geometry/sdf_cull_pass.h"
#include "passes/geometry/sdf_tile_pass.h"
#include "passes/geometry/triplanar_pass.h"
#include "passes/light/environment_pass.h"
#include "passes/light/field_occlusion_pass.h"
#include "passes/light/field_reflection_pass.h"
#include "passes/light/field_shadow_pass.h"
#include "passes/light/lighting_pass.h"
#include "passes/light/map_shadow_pass.h"
#include "passes/light/shadow_map_pass.h"
#include "passes/light/shadow_maps.h"
#include "passes/light/shadow_moments_pass.h"
#include "passes/light/shadow_range_pass.h"
#include "passes/light/translucency_pass.h"
#include "passes/post/motion_blur_pass.h"
#include "passes/post/motion_pass.h"
#include "passes/post/taa_pass.h"
#include "passes/post/taa_sharpen_pass.h"
#include "passes/post/temporal.h"
#include "passes/post/tone_pass.h"
#include "passes/world_field/world_triangles_pass.h"
#include "renderer/frame_plan.h"
#include "renderer/late_pass.h"
#include "renderer/renderer.h"
#include "resident/mesh_boxes.h"
#include "shared/sdf_params.h"

namespace brickfield {

/// What decides which passes a frame has.
struct FrameShape {
  bool hasClear = false, boxesFirst = false, hasBoxes = false, hasTiles = false, hasTriplanar = false;
  bool hasExactField = false, hasRtsdfField = false, hasFieldShadows = false, hasOcclusion = false;
  bool hasTranslucency = false, hasReflections = false, hasShadowMaps = false, hasShadowMoments = false,
       hasShadowRanges = false;
  bool mapsAnswer = false, hasTaa = false, hasMotionBlur = false;
  bool showsPicture = false, showsDebugView = false, showsFieldView = false, showsShadowMaps = false, showsTaa = false;
};

struct Renderer::Parts {
  explicit Parts(const ContextInfo& info);

  ShaderLibrary shaders;
  FrameTimers timers;
  DeformPass deform;
  ClearPass clear;
  MeshPass mesh;
  DepthCopyPass depthCopy;
  SdfCullPass sdfCull;
  SdfBoxPass sdfBox;
  BoxOverdrawPass boxOverdraw;
  EnvironmentPass environment;
  LightingPass lighting;
  TonePass tone;
  DebugViewPass debugView;
  LatePass<WorldTrianglesPass> worldTriangles;
  LatePass<PseudonormalsPass> pseudonormals;
  LatePass<FieldClearPass> fieldClear;
  LatePass<FieldSplatPass> fieldSplat;
  LatePass<FieldCandidatesPass> fieldCandidates;
  LatePass<FieldResolvePass> fieldResolve;
  LatePass<HierarchyRefitPass> hierarchyRefit;
  LatePass<RtsdfVoxelizePass> rtsdfVoxelize;
  LatePass<RtsdfJumpFloodPass> rtsdfJumpFlood;
  LatePass<RtsdfRaysPass> rtsdfRays;
  LatePass<ScreenBoxPass> screenBoxes;
  LatePass<SdfTilePass> sdfTiles;
  LatePass<TriplanarPass> triplanar;
  LatePass<FieldShadowPass> fieldShadow;
  LatePass<FieldOcclusionPass> fieldOcclusion;
  LatePass<OcclusionSpreadPass> occlusionSpread;
  LatePass<TranslucencyPass> translucency;
  LatePass<ReflectionPlacesPass> reflectionPlaces;
  LatePass<FieldReflectionPass> fieldReflection;
  LatePass<ReflectionShadePass> reflectionShade;
  LatePass<ReflectionSpreadPass> reflectionSpread;
  LatePass<FieldViewPass> fieldView;
  LatePass<ShadowMapPass> shadowMap;
  LatePass<ShadowMomentsPass> shadowMoments;
  LatePass<ShadowRangePass> shadowRange;
  LatePass<MapShadowPass> mapShadow;
  LatePass<ShadowMapViewPass> shadowMapView;
  LatePass<MotionPass> motion;
  LatePass<TaaPass> taa;
  LatePass<TaaSharpenPass> taaSharpen;
  LatePass<MotionBlurPass> motionBlur;
  LatePass<TaaViewPass> taaView;

  RendererSettings settings;
  const Scene* source = nullptr;
  std::unique_ptr<ResidentScene> scene;
  std::unique_ptr<FrameTargets> targets;
  VisibleBoxes visible;
  Buffer frameParams, counters;
  std::array<glm::vec3, 9> irradiance{};
  SceneFields fieldOfNode;                ///< without the fields: which nodes are SDF objects
  std::unique_ptr<FieldKeeper> field;     ///< null until a frame reads the world field
  std::unique_ptr<ShadowMaps> shadowMaps; ///< null until a frame asks for them
  std::unique_ptr<MeshBoxes> meshBoxes;
  std::vector<Box> drawBoxes;    ///< of the pose's mesh draws, metres from the anchor
  glm::dvec3 drawAnchorWorld{0}; ///< in the middle of the pose
  std::vector<DrawRun> meshRuns; ///< of the last frame
  std::vector<PosedLight> lights;
  std::unique_ptr<Temporal> temporal; ///< null: no temporal antialiasing
  View previousView;                  ///< of the last frame, where temporal has a history
  bool isFieldInFrame = false;
  std::vector<std::int32_t> nodeOfInstance; ///< of the SDF objects of the last frame
  Pose pose;
  View view;
  bool isPosed = false, isLit = false;

  std::vector<PlannedPass> plan(const FrameContext& context);
  shared::FrameParams fillParams() const;
  bool readsField() const;
  bool tracesTiles() const;
  const FieldFrame& prepareField();
  void placeDraws();
  MeshDraws meshDraws() const { return {scene->batches(), drawBoxes, drawAnchorWorld}; }
  void prepareShadowMaps(const shared::FrameParams& params);
  void prepareTemporal();
  void keepForNextFrame();

  template <typename Take>
  static void listPasses(const FrameShape& shape, const Take& take);
};

} // namespace brickfield
