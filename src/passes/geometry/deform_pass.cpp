// One dispatch a deformed primitive.
#include "passes/geometry/deform_pass.h"

namespace brickfield {

DeformPass::DeformPass(ShaderLibrary& shaders)
    : program_(shaders.load({"deform", {{GL_COMPUTE_SHADER, "passes/deform.comp.glsl"}}, {}, {}})) {}

PassDeclaration DeformPass::declare() {
  return {"deform", {{Resource::MeshVertices, Access::StorageRead}}, {{Resource::MeshVertices, Access::StorageWrite}}};
}

void DeformPass::record(const FrameContext& context) {
  if (context.scene.deformJobs().empty()) return;
  context.scene.bindDeform();
  for (const DeformJob& job : context.scene.deformJobs()) {
    program_->set("deformVertices", job.params.vertices);
    program_->set("deformSources", job.params.sources);
    program_->set("deformWeights", job.params.weights);
    program_->dispatchOver({static_cast<int>(job.params.vertices.y), 1, 1});
  }
}

} // namespace brickfield
