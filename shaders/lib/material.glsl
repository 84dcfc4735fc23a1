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

// Index of the sampler array is constant at each call, as GLSL 4.5 without extensions asks.
#define MATERIAL_SAMPLE(material, slot, uvSets) texture(material_textures[slot], textureCoordinate(material, slot, uvSets))
