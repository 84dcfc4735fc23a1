// Prepares an environment for image-based light: prefiltered radiance and the BRDF's table. Runs when the environment
// changes, not every frame.
#pragma once

#include "gpu/shader_library.h"
#include "gpu/texture.h"
#include "scene/lighting.h"

namespace brickfield {

class EnvironmentPass {
public:
  explicit EnvironmentPass(ShaderLibrary& shaders);
  /// Uploads and filters; afterwards radiance() has a roughness of mip / (mips - 1) in each mip.
  void prepare(const Environment& environment);

  const Texture& radiance() const { return radiance_; }
  const Texture& brdf() const { return brdf_; }

private:
  std::shared_ptr<Program> prefilter_;
  Texture radiance_;
  Texture brdf_;
  Sampler horizontalWrap_;
};

} // namespace brickfield
