// Morph targets and skins: source vertices of one primitive to deformed ones, every frame it moves. Twin of
// scene/pose.h deformPrimitive. Flat-shaded primitives take their normals from the deformed triangle when drawn.
#include "lib/octahedral.glsl"
#include "shared/bindings.h"
#include "shared/mesh_params.h"

layout(local_size_x = 64) in;

layout(std430, binding = kDeformSourceBinding) readonly buffer SourceBlock { MeshVertex sources[]; };
layout(std430, binding = kDeformResultBinding) writeonly buffer ResultBlock { MeshVertex results[]; };
// A vertex: `influences` words of joint (low 16 bits), then as many weights.
layout(std430, binding = kDeformInfluenceBinding) readonly buffer InfluenceBlock { uint influenceWords[]; };
// A target's vertex: position, normal and tangent offset, a row each.
layout(std430, binding = kDeformMorphBinding) readonly buffer MorphBlock { vec4 morphRows[]; };
layout(std430, binding = kDeformJointBinding) readonly buffer JointBlock { mat4 worldFromBind[]; };
layout(std430, binding = kDeformWeightBinding) readonly buffer WeightBlock { float morphWeights[]; };

uniform uvec4 deformVertices; // DeformParams, row by row
uniform uvec4 deformSources;
uniform uvec4 deformWeights;

void main() {
  uint vertex = gl_GlobalInvocationID.x;
  uint count = deformVertices.y;
  if (vertex >= count) return;
  MeshVertex source = sources[deformVertices.x + vertex];
  vec3 position = source.position.xyz;
  vec3 sourceNormal = directionFromOctahedral(unpackSnorm2x16(floatBitsToUint(source.position.w)));
  vec3 sourceTangent = directionFromOctahedral(unpackSnorm2x16(source.codes.x));
  vec3 normal = sourceNormal, tangent = sourceTangent;

  for (uint target = 0u; target < deformSources.z; ++target) {
    float weight = morphWeights[deformWeights.x + target];
    uint row = deformSources.y + (target * count + vertex) * 3u;
    position += weight * morphRows[row].xyz;
    normal += weight * morphRows[row + 1u].xyz;
    tangent += weight * morphRows[row + 2u].xyz;
  }

  uint influences = deformVertices.w;
  if (influences > 0u) {
    mat4 blended = mat4(0.0);
    uint word = deformSources.x + vertex * influences * 2u;
    for (uint i = 0u; i < influences; ++i)
      blended += uintBitsToFloat(influenceWords[word + influences + i]) *
                 worldFromBind[deformSources.w + influenceWords[word + i]];
    mat3 linear = mat3(blended);
    position = (blended * vec4(position, 1.0)).xyz;
    // The cofactor matrix alone, no flip: a mirroring joint turns the winding too, and normals stay on its side.
    normal = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1])) * normal;
    tangent = linear * tangent;
  }
  normal = dot(normal, normal) > 0.0 ? normalize(normal) : sourceNormal;
  tangent = dot(tangent, tangent) > 0.0 ? normalize(tangent) : sourceTangent;

  MeshVertex result = source;
  result.position = vec4(position, uintBitsToFloat(packSnorm2x16(octahedralFromDirection(normal))));
  result.codes.x = packSnorm2x16(octahedralFromDirection(tangent));
  results[deformVertices.z + vertex] = result;
}
