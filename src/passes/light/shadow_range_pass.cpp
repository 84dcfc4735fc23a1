// A dispatch a level, over all maps at once.
#include "passes/light/shadow_range_pass.h"

#include "passes/light/shadow_maps.h"
#include "shared/bindings.h"

namespace brickfield {

ShadowRangePass::ShadowRangePass(ShaderLibrary& shaders)
    : program_(shaders.load({"shadow_range", {{GL_COMPUTE_SHADER, "passes/shadow_range.comp.glsl"}}, {}, {}})) {}

PassDeclaration ShadowRangePass::declare() {
  return {"shadow_range", {{Resource::ShadowMap, Access::Sampled}}, {{Resource::ShadowRange, Access::ImageStore}}};
}

void ShadowRangePass::record(const FrameContext& context) {
  const ShadowMaps& maps = *context.shadowMaps;
  maps.bind();
  maps.ranges().bindImage(0, 0, GL_WRITE_ONLY);
  for (int level = 0; level < maps.rangeLevels(); ++level) {
    if (level > 0) glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    program_->set("levelIndex", level);
    program_->dispatchOver({maps.rangeBox(level).y, maps.rangeBox(level).y, maps.layerCount()});
  }
}

} // namespace brickfield
