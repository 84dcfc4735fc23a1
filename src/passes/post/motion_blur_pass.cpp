// Two dispatches and a copy: the picture cannot be blurred into itself.
#include "passes/post/motion_blur_pass.h"

#include "passes/post/temporal.h"
#include "shared/bindings.h"

namespace brickfield {

namespace {
constexpr int kTile = 16; // as MOTION_TILE of shaders/lib/motion_blur.glsl
}

MotionBlurPass::MotionBlurPass(ShaderLibrary& shaders)
    : tilesProgram_(shaders.load({"motion_tiles", {{GL_COMPUTE_SHADER, "passes/motion_tiles.comp.glsl"}}, {}, {}})),
      blurProgram_(shaders.load({"motion_blur", {{GL_COMPUTE_SHADER, "passes/motion_blur.comp.glsl"}}, {}, {}})) {}

PassDeclaration MotionBlurPass::declare() {
  return {"motion_blur",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::Motion, Access::Sampled},
           {Resource::Color, Access::Sampled}},
          {{Resource::History, Access::ImageStore}, {Resource::Color, Access::Attachment}}};
}

void MotionBlurPass::record(const FrameContext& context) {
  const Temporal& temporal = *context.temporal;
  const Texture& color = context.targets.color;
  const glm::ivec2 tiles = (glm::ivec2(color.width(), color.height()) + kTile - 1) / kTile;
  if (!tiles_ || tiles_.width() != tiles.x || tiles_.height() != tiles.y)
    tiles_ = Texture::make2D("motion_tiles", GL_RG16F, tiles.x, tiles.y);
  context.targets.bindGBuffer();
  temporal.motion.bind(shared::kMotionUnit);
  tiles_.bindImage(0, 0, GL_WRITE_ONLY);
  tilesProgram_->set("shutter", temporal.shutter);
  tilesProgram_->dispatchOver({kTile * tiles.x, kTile * tiles.y, 1});

  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  color.bind(shared::kColorUnit);
  tiles_.bind(shared::kMotionTileUnit);
  const Texture& blurred = temporal.before(); // of no more use to this frame
  blurred.bindImage(0, 0, GL_WRITE_ONLY);
  blurProgram_->set("shutter", temporal.shutter);
  blurProgram_->dispatchOver({color.width(), color.height(), 1});

  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glCopyImageSubData(blurred.id(), GL_TEXTURE_2D, 0, 0, 0, 0, color.id(), GL_TEXTURE_2D, 0, 0, 0, 0, color.width(),
                     color.height(), 1);
}

} // namespace brickfield
