// A glTF material at a point of a mesh: textures, factors, alpha cut.
#include "shared/bindings.h"
#include "shared/mesh_params.h"

layout(std430, binding = kMaterialBinding) readonly buffer MaterialBlock { MaterialRow materials[]; };

layout(binding = kMaterialTextureUnit) uniform sampler2D material_textures[MATERIAL_TEXTURES];

bool usesTexture(MaterialRow material, uint slot) { return (uint(material.flags.z) >> slot & 1u) != 0u; }

vec2 textureCoordinate(MaterialRow material, uint slot, vec4 uvSets) {
  vec3 uv = vec3((uint(material.flags.w) >> slot & 1u) != 0u ? uvSets.zw : uvSets.xy, 1.0);
  return vec2(dot(material.textureFromUv[slot * 2u].xyz, uv), dot(material.textureFromUv[slot * 2u + 1u].xyz, uv));
}

// Texture coordinates of all slots, with their differences between pixels: taken once outside of all conditions, where
// they are defined. (llvmpipe's implicit differences of coordinates read from a storage buffer are wrong in three pixels
// of four, which then show the coarsest mip.)
struct UvPixel {
  vec4 sets, dx, dy;
};

vec4 sampleMaterial(sampler2D image, MaterialRow material, uint slot, UvPixel uv) {
  bool second = (uint(material.flags.w) >> slot & 1u) != 0u;
  vec3 rowU = material.textureFromUv[slot * 2u].xyz, rowV = material.textureFromUv[slot * 2u + 1u].xyz;
  vec2 dx = second ? uv.dx.zw : uv.dx.xy, dy = second ? uv.dy.zw : uv.dy.xy;
  return textureGrad(image, textureCoordinate(material, slot, uv.sets), vec2(dot(rowU.xy, dx), dot(rowV.xy, dx)),
                     vec2(dot(rowU.xy, dy), dot(rowV.xy, dy)));
}

// Index of the sampler array is constant at each call, as GLSL 4.5 without extensions asks.
#define MATERIAL_SAMPLE(material, slot, uv) sampleMaterial(material_textures[slot], material, slot, uv)
