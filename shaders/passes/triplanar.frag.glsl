// Gives the SDF objects of one material that have no attributes of their own what its textures say, in object space. It
// reads the surface normal of the target that it writes the shading normal to: of its own pixel, after a texture barrier.
#include "lib/octahedral.glsl"
#include "lib/packing.glsl"
#include "lib/sdf_space.glsl"
#include "lib/triplanar.glsl"

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };
layout(std430, binding = kSdfLookBinding) readonly buffer SdfLookBlock { SdfLook sdfLooks[]; };

layout(binding = kDepthUnit) uniform sampler2D depth;
layout(binding = kNormalUnit) uniform sampler2D normal_world_oct;
layout(binding = kIdUnit) uniform usampler2D id;

layout(location = 0) out vec4 shading_normal_oct; // xy; zw, the surface normal, is kept by a mask
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 material;           // metallic, roughness, occlusion, unlit
layout(location = 3) out vec3 emission;

uniform int materialRow;

// A surface seen edge on is filtered as one that is twenty pixels deep.
const float LEAST_FACING = 0.05;

// From the surface's point to where the ray of another pixel meets its plane.
vec3 offsetOnPlane(vec2 pixel, vec3 pointEye, vec3 normal) {
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(pixel), originEye, directionWorld);
  float facing = min(dot(directionWorld, normal), -LEAST_FACING);
  return originEye + dot(pointEye - originEye, normal) / facing * directionWorld - pointEye;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint packedId = texelFetch(id, pixel, 0).r;
  if (kindOfId(packedId) != KIND_SDF) discard;
  SdfInstance instance = sdfInstances[numberOfId(packedId)];
  SdfLook look = sdfLooks[numberOfId(packedId)];
  if (look.texturing.x <= 0.0 || int(look.texturing.y) != materialRow) discard;

  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(gl_FragCoord.xy), originEye, directionWorld);
  vec3 pointEye = originEye + rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r) * directionWorld;
  vec3 normalWorld = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);

  float voxel = look.objectFromGrid.w;
  TriplanarPoint at;
  at.pointObject = look.objectFromGrid.xyz + voxel * gridFromEye(instance, pointEye);
  // Normals are carried back by the transpose of worldFromGrid, whose axes are those of object space.
  at.normalObject = normalize(normalWorld.x * instance.worldFromGrid[0].xyz + normalWorld.y * instance.worldFromGrid[1].xyz +
                              normalWorld.z * instance.worldFromGrid[2].xyz);
  at.dx = voxel * rowsTimesDirection(instance.gridFromWorld, offsetOnPlane(gl_FragCoord.xy + vec2(1.0, 0.0), pointEye, normalWorld));
  at.dy = voxel * rowsTimesDirection(instance.gridFromWorld, offsetOnPlane(gl_FragCoord.xy + vec2(0.0, 1.0), pointEye, normalWorld));
  MaterialRow m = materials[materialRow];
  TriplanarSurface surface = sampleTriplanar(m, at, look.texturing.x);

  vec3 n = surface.normalObject;
  vec3 shadingWorld = n.x * instance.gridFromWorld[0].xyz + n.y * instance.gridFromWorld[1].xyz + n.z * instance.gridFromWorld[2].xyz;
  shading_normal_oct = vec4(octahedralFromDirection(normalize(shadingWorld)), 0.0, 0.0);
  albedo = vec4(surface.baseColor.rgb, 1.0);
  material = vec4(surface.metallicRoughness, surface.occlusion, float(m.flags.x));
  emission = surface.emission;
}
