// Mip 0 is the environment itself (the sky is drawn from it), the others GGX lobes of growing roughness.
#include "passes/light/environment_pass.h"

#include <algorithm>

#include "shared/bindings.h"

namespace brickfield {

namespace {
constexpr int kRoughnessMips = 6;
constexpr int kBrdfSide = 64;
// With mip-matched samples 64 leave no visible noise (checked on studio_1k.hdr, whose lamps are the worst case).
constexpr std::uint32_t kPrefilterSamples = 64;
} // namespace

EnvironmentPass::EnvironmentPass(ShaderLibrary& shaders)
    : prefilter_(shaders.load(
          {"environment_prefilter", {{GL_COMPUTE_SHADER, "passes/environment_prefilter.comp.glsl"}}, {}, {}})),
      brdf_(Texture::make2D("environment_brdf", GL_RG16F, kBrdfSide, kBrdfSide)) {
  SamplerOptions options;
  options.minFilter = GL_LINEAR_MIPMAP_LINEAR;
  options.wrapS = GL_REPEAT;
  horizontalWrap_ = Sampler("environment_wrap", options);
  const auto table =
      shaders.load({"environment_brdf", {{GL_COMPUTE_SHADER, "passes/environment_brdf.comp.glsl"}}, {}, {}});
  brdf_.bindImage(0, 0, GL_WRITE_ONLY);
  table->dispatchOver({kBrdfSide, kBrdfSide, 1});
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void EnvironmentPass::prepare(const Environment& environment) {
  const glm::ivec2 size(environment.size);
  Texture source = Texture::make2D("environment_source", GL_RGBA16F, size.x, size.y, 0);
  std::vector<glm::vec4> texels;
  // Half floats end at 65504; a brighter lamp is clipped rather than infinite.
  for (const glm::vec3& radiance : environment.radiance)
    texels.emplace_back(glm::min(radiance, glm::vec3(65504)), 1.0f);
  source.upload(0, {0, 0, 0}, {size, 1}, std::as_bytes(std::span(texels)),
                PixelLayout{GL_RGBA, GL_FLOAT, 4, 16, false, false});
  source.generateMipmaps();

  int mips = 1;
  while (mips < kRoughnessMips && (std::min(size.x, size.y) >> mips) > 0) ++mips;
  radiance_ = Texture::make2D("environment_prefiltered", GL_RGBA16F, size.x, size.y, mips);
  glCopyImageSubData(source.id(), GL_TEXTURE_2D, 0, 0, 0, 0, radiance_.id(), GL_TEXTURE_2D, 0, 0, 0, 0, size.x, size.y,
                     1);
  source.bind(shared::kEnvironmentUnit);
  horizontalWrap_.bind(shared::kEnvironmentUnit);
  for (int mip = 1; mip < mips; ++mip) {
    radiance_.bindImage(0, mip, GL_WRITE_ONLY);
    prefilter_->set("roughness", static_cast<float>(mip) / static_cast<float>(mips - 1));
    prefilter_->set("sampleCount", kPrefilterSamples);
    const glm::ivec3 extent = radiance_.extent(mip);
    prefilter_->dispatchOver({extent.x, extent.y, 1});
  }
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  Sampler::unbind(shared::kEnvironmentUnit);
}

} // namespace brickfield
