// One dispatch over the picture for all lights: they share the reads of the G-buffer.
#include "passes/light/field_shadow_pass.h"

#include "passes/world_field/field_frame.h"

namespace brickfield {

FieldShadowPass::FieldShadowPass(ShaderLibrary& shaders)
    : program_(shaders.load({"field_shadow", {{GL_COMPUTE_SHADER, "passes/field_shadow.comp.glsl"}}, {}, {}})),
      countingProgram_(shaders.load({"field_shadow_counting",
                                     {{GL_COMPUTE_SHADER, "passes/field_shadow.comp.glsl"}},
                                     {{"COUNTERS_ON", "1"}},
                                     {}})) {}

PassDeclaration FieldShadowPass::declare() {
  return {"field_shadow",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::WorldField, Access::Sampled}},
          {{Resource::Shadow, Access::ImageStore}, {Resource::Counters, Access::StorageWrite}}};
}

void FieldShadowPass::record(const FrameContext& context) {
  bindWorldField(*context.field);
  context.targets.bindGBuffer();
  context.scene.bindLights();
  context.counters.bindStorage(shared::kPassBufferABinding);
  context.targets.shadow.bindImage(0, 0, GL_WRITE_ONLY);
  Program& program = context.countersOn ? *countingProgram_ : *program_;
  program.set("raysOfPenumbra", context.shadowRays);
  program.dispatchOver({context.targets.shadow.width(), context.targets.shadow.height(), 1});
}

} // namespace brickfield
