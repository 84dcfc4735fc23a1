// One work group a row of the schedule; barriers between what builds on each other.
#include "passes/world_field/hierarchy_refit_pass.h"

namespace brickfield {

HierarchyRefitPass::HierarchyRefitPass(ShaderLibrary& shaders)
    : program_(shaders.load({"hierarchy_refit", {{GL_COMPUTE_SHADER, "passes/hierarchy_refit.comp.glsl"}}, {}, {}})) {}

PassDeclaration HierarchyRefitPass::declare() {
  return {"hierarchy_refit",
          {{Resource::WorldTriangles, Access::StorageRead}},
          {{Resource::TriangleHierarchy, Access::StorageWrite}}};
}

void HierarchyRefitPass::record(const TriangleHierarchy& hierarchy, const Buffer& triangles) {
  const RefitSchedule& schedule = hierarchy.schedule();
  hierarchy.bindRefit(triangles);
  program_->use();
  const auto dispatch = [&](const RefitSchedule::Rows& rows, bool lists) {
    if (rows.count == 0) return;
    program_->set("firstRow", rows.first);
    program_->set("takesLists", lists);
    glDispatchCompute(rows.count, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  };
  for (const RefitSchedule::Rows& rows : schedule.heights) dispatch(rows, false);
  dispatch(schedule.lists, true);
  dispatch(schedule.top, true);
}

} // namespace brickfield
