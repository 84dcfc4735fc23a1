// One work group a row of the schedule; barriers between what builds on each other.
#include "passes/world_field/hierarchy_refit_pass.h"

#include "core/math.h"

namespace brickfield {

namespace {
constexpr std::uint32_t kMostGroups = 65535;
}

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
    program_->set("rowCount", rows.count);
    // A device may take no more than 65,535 groups along an axis.
    const std::uint32_t across = std::min(rows.count, kMostGroups);
    glDispatchCompute(across, ceilDivide(rows.count, across), 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  };
  for (const RefitSchedule::Rows& rows : schedule.heights) dispatch(rows, false);
  dispatch(schedule.lists, true);
  dispatch(schedule.top, true);
}

} // namespace brickfield
