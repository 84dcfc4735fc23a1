// A compute pass over the picture: fragment shaders have a fraction of some GPUs' units (NUMBERS of the design).
#include "passes/light/lighting_pass.h"

#include <algorithm>

namespace brickfield {

LightingPass::LightingPass(ShaderLibrary& shaders)
    : program_(shaders.load({"lighting", {{GL_COMPUTE_SHADER, "passes/lighting.comp.glsl"}}, {}, {}})) {}

PassDeclaration LightingPass::declare() {
  return {"lighting",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::Shadow, Access::Sampled},
           {Resource::Environment, Access::Sampled}},
          {{Resource::Color, Access::ImageStore}},
          {{Resource::Shadow, Access::Sampled},
           {Resource::Occlusion, Access::Sampled},
           {Resource::Translucency, Access::Sampled},
           {Resource::Reflection, Access::Sampled}}};
}

void LightingPass::record(const FrameContext& context) {
  context.targets.bindGBuffer();
  context.environment.bind(shared::kEnvironmentUnit);
  context.environmentBrdf.bind(shared::kEnvironmentBrdfUnit);
  context.scene.bindLights();
  context.targets.shadow.bind(shared::kShadowUnit);
  const std::uint32_t shadowed = context.shadows ? context.scene.lightCount() : 0;
  program_->set("shadowedLights", std::min(static_cast<int>(shadowed), shared::MOST_SHADOWED_LIGHTS));
  const bool isOccluded = context.occlusion.form != OcclusionForm::Off;
  if (isOccluded) context.targets.occlusion.bind(shared::kOcclusionUnit);
  program_->set("isOccluded", isOccluded);
  const bool isTranslucent = context.translucency.source != TranslucencySource::Off;
  if (isTranslucent) context.targets.translucent.bind(shared::kTranslucentUnit);
  program_->set("isTranslucent", isTranslucent);
  const bool isMirrored = context.reflections.method != ReflectionMethod::Off;
  if (isMirrored) context.targets.reflection.bind(shared::kReflectionUnit);
  program_->set("isMirrored", isMirrored);
  program_->set("scale", context.reflections.scale);
  program_->set("isBlinnPhong", context.brdf == BrdfModel::BlinnPhong);
  context.targets.color.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.color.width(), context.targets.color.height(), 1});
}

} // namespace brickfield
