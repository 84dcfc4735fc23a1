// The textures of a frame and the framebuffers over them, for one picture size.
#pragma once

#include <glm/glm.hpp>

#include "gpu/framebuffer.h"
#include "gpu/texture.h"
#include "passes/work_list.h"

namespace brickfield {

struct FrameTargets {
  explicit FrameTargets(glm::uvec2 sizePixels);

  glm::uvec2 size;
  Texture depth;           ///< D32F, reverse Z
  Texture depthMesh;       ///< D32F: the meshes' depth alone
  Texture depthTraced;     ///< R32F: depth of all where SDF objects were traced in compute; none without fitTiles
  Texture normalWorldOct;  ///< RGBA16_SNORM: shading normal, surface normal
  Texture albedo;          ///< SRGB8_A8
  Texture albedoEncoded;   ///< RGBA8: a view of it for image stores; as depthTraced
  Texture material;        ///< RGBA8: metallic, roughness, occlusion, unlit
  Texture emission;        ///< R11F_G11F_B10F
  Texture id;              ///< R32UI: node or SDF instance << 2 | kind, lib/packing.glsl
  Texture trace;           ///< RG32UI: trace steps, brick that was hit and its level
  Texture shadow;          ///< RGBA8: visible shares of the first lights
  Texture shadowHalf;      ///< RGBA8: the same of every second pixel of every second row
  Texture shadowReads;     ///< R32UI: distances read for it; written in frames that count
  Texture occlusion;       ///< R8: open share of the hemisphere; none without fitOcclusion
  Texture occlusionTraced; ///< RG32UI: the same at fewer pixels, lib/occlusion_code.glsl
  Texture translucent; ///< RGBA16F: radiance through SDF objects, share of diffuse light; none without fitTranslucency
  Texture thickness;   ///< R32F: metres of an SDF object along the view ray; the same
  WorkList shadowList{"shadow_list"};         ///< squares of pixels that shadows at half resolution leave open
  WorkList reflectionList{"reflection_list"}; ///< pixels whose reflected rays are traced
  Texture reflectionHit; ///< RGBA32UI: what these meet, lib/reflection_code.glsl; none without fitReflections
  Texture reflection;    ///< RGBA16F: radiance that smooth surfaces mirror; the same
  Texture color;         ///< RGBA16F: linear radiance
  Texture picture;       ///< RGBA8: after the tone curve
  Texture boxOverdraw;   ///< R16F
  Framebuffer gbuffer;   ///< depth and the six layers, in the order of the fragment outputs
  Framebuffer surface;   ///< of it what textures decide: normal, albedo, material, emission
  Framebuffer overdraw;

  /// Makes the textures that SDF objects are traced into in compute, or frees them.
  void fitTiles(bool isMade);
  /// Depths of all that is seen.
  const Texture& visibleDepth() const { return depthTraced ? depthTraced : depth; }
  /// Makes the textures of occlusion that is traced at every scale-th pixel along both axes; 0: frees them.
  void fitOcclusion(int scale);
  /// Makes the textures of translucency, or frees them.
  void fitTranslucency(bool isMade);
  /// Makes the textures of reflections, or frees them.
  void fitReflections(bool isMade);
  /// Binds the G-buffer's textures to the units of lib/gbuffer.glsl.
  void bindGBuffer() const;
  std::size_t bytes() const;
};

} // namespace brickfield
