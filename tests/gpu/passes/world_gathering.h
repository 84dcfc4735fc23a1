// A scene with the passes that gather its triangles, for the tests of these and of what reads them.
#pragma once

#include <filesystem>
#include <vector>

#include "passes/geometry/deform_pass.h"
#include "passes/world_field/world_triangles_pass.h"

namespace brickfield::test {

/// One scene with what gathers its triangles.
struct Gathering {
  explicit Gathering(const Scene& source, const SceneFields& fields = {})
      : scene(source),
        resident(source, fields),
        world(source, fields, resident),
        shaders(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders"),
        deform(shaders),
        positions(shaders),
        pseudonormals(shaders) {}

  /// Like WorldTriangles::setPose.
  bool set(const Pose& pose, glm::dvec3 anchor) {
    resident.setPose(scene, pose);
    return world.setPose(scene, pose, anchor);
  }
  /// Deforms, gathers, settles; all triangles.
  std::vector<shared::WorldTriangle> gather() {
    FrameContext context{resident, targets, visible, counters, none, none, DrawOrder::MeshesFirst, false, &world};
    deform.record(context);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    positions.record(context);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    pseudonormals.record(context);
    world.settle();
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return world.triangles().read<shared::WorldTriangle>(0, world.triangleCount());
  }

  const Scene& scene;
  ResidentScene resident;
  WorldTriangles world;
  ShaderLibrary shaders;
  DeformPass deform;
  WorldTrianglesPass positions;
  PseudonormalsPass pseudonormals;
  FrameTargets targets{{4, 4}};
  VisibleBoxes visible;
  Buffer counters{"counters", 64};
  Texture none;
};

} // namespace brickfield::test
