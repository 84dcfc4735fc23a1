// Formats are chosen where the layer is declared; here they become textures.
#include "passes/frame_targets.h"

#include "shared/bindings.h"

namespace brickfield {

namespace {
Texture layer(const char* label, GLenum format, glm::uvec2 size) {
  return Texture::make2D(label, format, static_cast<int>(size.x), static_cast<int>(size.y));
}
} // namespace

FrameTargets::FrameTargets(glm::uvec2 sizePixels)
    : size(sizePixels),
      depth(layer("depth", GL_DEPTH_COMPONENT32F, size)),
      depthMesh(layer("depth_mesh", GL_DEPTH_COMPONENT32F, size)),
      normalWorldOct(layer("normal_world_oct", GL_RGBA16_SNORM, size)),
      albedo(layer("albedo", GL_SRGB8_ALPHA8, size)),
      material(layer("material", GL_RGBA8, size)),
      emission(layer("emission", GL_R11F_G11F_B10F, size)),
      id(layer("id", GL_R32UI, size)),
      trace(layer("trace", GL_RG32UI, size)),
      shadow(layer("shadow", GL_RGBA8, size)),
      shadowHalf(layer("shadow_half", GL_RGBA8, (size + 1u) / 2u)),
      shadowReads(layer("shadow_reads", GL_R32UI, size)),
      color(layer("color", GL_RGBA16F, size)),
      picture(layer("picture", GL_RGBA8, size)),
      boxOverdraw(layer("box_overdraw", GL_R16F, size)),
      gbuffer("gbuffer", {{GL_COLOR_ATTACHMENT0, &normalWorldOct},
                          {GL_COLOR_ATTACHMENT1, &albedo},
                          {GL_COLOR_ATTACHMENT2, &material},
                          {GL_COLOR_ATTACHMENT3, &emission},
                          {GL_COLOR_ATTACHMENT4, &id},
                          {GL_COLOR_ATTACHMENT5, &trace},
                          {GL_DEPTH_ATTACHMENT, &depth}}),
      surface("surface", {{GL_COLOR_ATTACHMENT0, &normalWorldOct},
                          {GL_COLOR_ATTACHMENT1, &albedo},
                          {GL_COLOR_ATTACHMENT2, &material},
                          {GL_COLOR_ATTACHMENT3, &emission}}),
      overdraw("box_overdraw", {{GL_COLOR_ATTACHMENT0, &boxOverdraw}}) {}

void FrameTargets::fitTiles(bool isMade) {
  if (!isMade) depthTraced = {}, albedoEncoded = {};
  if (!isMade || depthTraced) return;
  depthTraced = layer("depth_traced", GL_R32F, size);
  albedoEncoded = Texture::viewOf("albedo_encoded", albedo, GL_RGBA8);
}

void FrameTargets::fitOcclusion(int scale) {
  if (scale == 0) {
    occlusion = {}, occlusionTraced = {};
    return;
  }
  const glm::uvec2 traced = (size + static_cast<unsigned>(scale) - 1u) / static_cast<unsigned>(scale);
  if (!occlusion) occlusion = layer("occlusion", GL_R8, size);
  if (!occlusionTraced || occlusionTraced.width() != static_cast<int>(traced.x) ||
      occlusionTraced.height() != static_cast<int>(traced.y))
    occlusionTraced = layer("occlusion_traced", GL_RG32UI, traced);
}

void FrameTargets::fitTranslucency(bool isMade) {
  if (!isMade) translucent = {}, thickness = {};
  if (!isMade || thickness) return;
  translucent = layer("translucent", GL_RGBA16F, size);
  thickness = layer("thickness", GL_R32F, size);
}

void FrameTargets::fitReflections(bool isMade) {
  if (!isMade) reflectionHit = {}, reflection = {}, reflectionList = WorkList("reflection_list");
  if (!isMade || reflection) return;
  reflectionHit = layer("reflection_hit", GL_RGBA32UI, size);
  reflection = layer("reflection", GL_RGBA16F, size);
}

void FrameTargets::bindGBuffer() const {
  visibleDepth().bind(shared::kDepthUnit);
  normalWorldOct.bind(shared::kNormalUnit);
  albedo.bind(shared::kAlbedoUnit);
  material.bind(shared::kMaterialUnit);
  emission.bind(shared::kEmissionUnit);
  id.bind(shared::kIdUnit);
  trace.bind(shared::kTraceUnit);
}

std::size_t FrameTargets::bytes() const {
  std::size_t sum = 0;
  for (const Texture* texture :
       {&depth,       &depthMesh, &depthTraced,   &normalWorldOct, &albedo,      &material,  &emission,
        &id,          &trace,     &shadow,        &shadowHalf,     &shadowReads, &occlusion, &occlusionTraced,
        &translucent, &thickness, &reflectionHit, &reflection,     &color,       &picture,   &boxOverdraw})
    if (*texture) sum += texture->bytes();
  return sum + shadowList.bytes() + reflectionList.bytes();
}

} // namespace brickfield
