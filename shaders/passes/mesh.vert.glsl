// Triangle meshes into the G-buffer: one vertex format, the draw's row from an instance attribute.
#include "lib/frame.glsl"
#include "lib/octahedral.glsl"
#include "shared/mesh_params.h"

layout(std430, binding = kMeshDrawBinding) readonly buffer MeshDrawBlock { MeshDraw meshDraws[]; };

layout(location = 0) in vec3 positionObject;
layout(location = 1) in vec2 normalOct;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec2 tangentOct;
layout(location = 4) in vec4 color;
layout(location = 5) in uint bitangentSign;
layout(location = 6) in uint drawIndex;

layout(location = 0) out vec3 pointEye;
layout(location = 1) out vec3 normalWorld;
layout(location = 2) out vec4 tangentWorld; // w: sign of the bitangent, 0 without tangents
layout(location = 3) out vec4 uvSets;
layout(location = 4) out vec4 vertexColor;
layout(location = 5) flat out uint draw;
#ifdef MOTION_ON
layout(std430, binding = kPassBufferABinding) readonly buffer MotionBlock { MeshMotion meshMotions[]; };
layout(std430, binding = kPassBufferBBinding) readonly buffer PreviousVertexBlock { MeshVertex previousVertices[]; };
layout(std430, binding = kMotionVertexBinding) readonly buffer VertexBlock { MeshVertex vertices[]; };
layout(location = 6) out vec3 previousPointEye;

// Where the vertex was in the frame before, from the eye of now.
vec3 previousPlace() {
  MeshMotion motion = meshMotions[drawIndex];
  int number = gl_VertexID - motion.vertices.y;
  vec3 position = motion.vertices.x >= 0 ? previousVertices[motion.vertices.x + number].position.xyz
                                         : vertices[motion.vertices.z + number].position.xyz;
  return mat3(motion.previousWorldFromObject) * position + (motion.previousWorldFromObject[3].xyz - frame.eyeWorld.xyz);
}
#endif

void main() {
  MeshDraw row = meshDraws[drawIndex];
  mat3 linear = mat3(row.worldFromObject);
  bool mirrored = (uint(row.ids.z) & DRAW_MIRRORED) != 0u;
  // The cofactor matrix carries normals under any affine transform; a mirror turns its result around.
  mat3 cofactor = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
  pointEye = linear * positionObject + (row.worldFromObject[3].xyz - frame.eyeWorld.xyz);
  normalWorld = cofactor * directionFromOctahedral(normalOct) * (mirrored ? -1.0 : 1.0);
  float handedness = bitangentSign == 0u ? 0.0 : bitangentSign == 1u ? 1.0 : -1.0;
  tangentWorld = vec4(linear * directionFromOctahedral(tangentOct), mirrored ? -handedness : handedness);
  uvSets = uv;
  vertexColor = color;
  draw = drawIndex;
#ifdef MOTION_ON
  previousPointEye = previousPlace();
#endif
  gl_Position = frame.clipFromEye * vec4(pointEye, 1.0);
}
