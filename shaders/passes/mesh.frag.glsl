// G-buffer of triangle meshes. Back faces of single-sided materials are culled by the fixed function (the draw sets the
// front face of mirrored instances); here alpha is cut and normals are mapped.
#include "lib/frame.glsl"
#include "lib/material.glsl"
#include "lib/motion.glsl"
#include "lib/octahedral.glsl"
#include "lib/packing.glsl"

layout(std430, binding = kMeshDrawBinding) readonly buffer MeshDrawBlock { MeshDraw meshDraws[]; };

layout(location = 0) in vec3 pointEye;
layout(location = 1) in vec3 normalWorld;
layout(location = 2) in vec4 tangentWorld;
layout(location = 3) in vec4 uvSets;
layout(location = 4) in vec4 vertexColor;
layout(location = 5) flat in uint draw;

layout(location = 0) out vec4 normal_world_oct; // xy: shading normal; zw: surface normal
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 material;         // metallic, roughness, occlusion, unlit
layout(location = 3) out vec3 emission;
layout(location = 4) out uint id;
#ifdef MOTION_ON
layout(location = 6) in vec3 previousPointEye;
layout(location = 6) out vec4 motion;
#endif

// The triangle's own normal, turned towards the viewer.
vec3 faceNormal() {
  vec3 n = cross(dFdx(pointEye), dFdy(pointEye));
  vec3 towardsEye = frame.projection.z > 0.5 ? frame.worldFromView[2].xyz : -pointEye;
  return dot(n, towardsEye) < 0.0 ? -n : n;
}

void main() {
  MeshDraw row = meshDraws[draw];
  MaterialRow m = materials[row.ids.y];

  // Differences between neighbours first: after a discard they are undefined.
  vec3 face = faceNormal();
  UvPixel uv = UvPixel(uvSets, dFdx(uvSets), dFdy(uvSets));
  vec4 base = m.baseColor * vertexColor;
  if (usesTexture(m, MATERIAL_BASE_COLOR)) base *= MATERIAL_SAMPLE(m, MATERIAL_BASE_COLOR, uv);
  vec2 metallicRoughness = m.factors.xy;
  if (usesTexture(m, MATERIAL_METALLIC_ROUGHNESS))
    metallicRoughness *= MATERIAL_SAMPLE(m, MATERIAL_METALLIC_ROUGHNESS, uv).bg;
  float occlusion = 1.0;
  if (usesTexture(m, MATERIAL_OCCLUSION))
    occlusion = 1.0 + m.factors.w * (MATERIAL_SAMPLE(m, MATERIAL_OCCLUSION, uv).r - 1.0);
  vec3 emitted = m.emission.rgb;
  if (usesTexture(m, MATERIAL_EMISSION)) emitted *= MATERIAL_SAMPLE(m, MATERIAL_EMISSION, uv).rgb;
  vec3 mapped = vec3(0.0, 0.0, 1.0);
  if (usesTexture(m, MATERIAL_NORMAL))
    mapped = (MATERIAL_SAMPLE(m, MATERIAL_NORMAL, uv).xyz * 2.0 - 1.0) * vec3(m.factors.zz, 1.0);

#ifdef ALPHA_MASK
  if (base.a < m.emission.w) discard;
#endif

  bool flatNormals = (uint(row.ids.z) & DRAW_FLAT_NORMALS) != 0u;
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 n = flatNormals || dot(normalWorld, normalWorld) == 0.0 ? face : normalWorld * side;
  n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0, 1.0, 0.0);
  vec3 shading = n;
  if (usesTexture(m, MATERIAL_NORMAL) && tangentWorld.w != 0.0) {
    vec3 tangent = tangentWorld.xyz - n * dot(n, tangentWorld.xyz);
    if (dot(tangent, tangent) > 0.0) {
      tangent = normalize(tangent);
      // A back face sees the mapped normal from behind: tangent and bitangent turn with it.
      vec3 bitangent = cross(n * side, tangent) * tangentWorld.w;
      shading = normalize(tangent * mapped.x * side + bitangent * mapped.y * side + n * mapped.z);
    }
  }
  normal_world_oct = vec4(octahedralFromDirection(shading), octahedralFromDirection(n));
  albedo = vec4(base.rgb, 1.0);
  material = vec4(metallicRoughness, occlusion, float(m.flags.x));
  emission = emitted;
  id = packId(uint(row.ids.x), KIND_MESH);
#ifdef MOTION_ON
  motion = vec4(motionOf(pointEye, previousPointEye), 0.0);
#endif
}
