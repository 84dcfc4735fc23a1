// Triangle meshes into a shadow map: the frame's parameters are those of the light's view.
#include "lib/frame.glsl"
#include "shared/mesh_params.h"

layout(std430, binding = kMeshDrawBinding) readonly buffer MeshDrawBlock { MeshDraw meshDraws[]; };

layout(location = 0) in vec3 positionObject;
layout(location = 2) in vec4 uv;
layout(location = 4) in vec4 color;
layout(location = 6) in uint drawIndex;

layout(location = 0) out vec4 uvSets;
layout(location = 1) out float vertexAlpha;
layout(location = 2) flat out int materialRow;

void main() {
  MeshDraw row = meshDraws[drawIndex];
  uvSets = uv;
  vertexAlpha = color.a;
  materialRow = row.ids.y;
  vec3 pointEye = mat3(row.worldFromObject) * positionObject + (row.worldFromObject[3].xyz - frame.eyeWorld.xyz);
  gl_Position = frame.clipFromEye * vec4(pointEye, 1.0);
}
