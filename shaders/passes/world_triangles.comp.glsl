// Corners of the triangles of what moved, where they stand in anchored space. Welded corners come out with the same
// bits, because the same vertices go through the same operations.
#include "lib/finite.glsl"
#include "lib/triangle_distance.glsl"
#include "shared/mesh_params.h"
#include "shared/world_field_params.h"
#include "shared/world_triangles_params.h"

layout(local_size_x = GATHER_TRIANGLES) in;

layout(std430, binding = kGatherTriangleBinding) writeonly buffer TriangleBlock { WorldTriangle worldTriangles[]; };
layout(std430, binding = kGatherFaceBinding) writeonly buffer FaceBlock { WorldFace worldFaces[]; };
layout(std430, binding = kGatherInstanceBinding) readonly buffer InstanceBlock { WorldInstance worldInstances[]; };
layout(std430, binding = kGatherTopologyBinding) readonly buffer TopologyBlock { TopologyRow topology[]; };
layout(std430, binding = kGatherChunkBinding) readonly buffer ChunkBlock { GatherChunk chunks[]; };
layout(std430, binding = kGatherVertexBinding) readonly buffer VertexBlock { MeshVertex vertices[]; };

uniform uint chunkCount;

// Unit; zero where the triangle's height is less than 2^-20 of its length: then half a radian or more is rounding.
vec3 faceNormal(vec3 a, vec3 b, vec3 c) {
  vec3 normal = areaNormal(a, b, c), ab = b - a, bc = c - b, ca = a - c;
  float longest = max(dot(ab, ab), max(dot(bc, bc), dot(ca, ca)));
  return length(normal) > 9.5e-7 * longest ? unitOrZero(normal) : vec3(0.0);
}

float angleAt(vec3 tip, vec3 first, vec3 second) {
  float y = length(cross(first - tip, second - tip)), x = dot(first - tip, second - tip);
  return y > 0.0 || x != 0.0 ? atan(y, x) : 0.0;
}

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= chunkCount) return;
  GatherChunk chunk = chunks[number];
  if (gl_LocalInvocationID.x >= chunk.count) return;
  WorldInstance instance = worldInstances[chunk.instance];
  uint triangle = chunk.first + gl_LocalInvocationID.x;
  uvec4 corners = topology[instance.triangles.z + triangle].corners;
  bool mirrored = (instance.vertices.w & WORLD_INSTANCE_MIRRORED) != 0u;

  vec3 points[3];
  bool finite = true;
  for (int corner = 0; corner < 3; ++corner) {
    vec3 pointObject = vertices[corners[corner] + chunk.vertexOffset].position.xyz;
    precise vec3 pointAnchored = (instance.anchoredFromObject * vec4(pointObject, 1.0)).xyz;
    points[corner] = pointAnchored;
    finite = finite && isFinite(pointAnchored);
  }
  uint flags = corners.w;
  if ((instance.vertices.w & WORLD_INSTANCE_FLAT) != 0u) flags &= ~WORLD_TRIANGLE_CLOSED;
  if (!finite) flags |= WORLD_TRIANGLE_EMPTY;
  if ((flags & WORLD_TRIANGLE_EMPTY) != 0u) points[0] = points[1] = points[2] = vec3(0.0);

  WorldTriangle result;
  result.a = vec4(points[0], 0.0);
  result.b = vec4(mirrored ? points[2] : points[1], 0.0);
  result.c = vec4(mirrored ? points[1] : points[2], 0.0);
  result.codes = uvec4(0u, 0u, 0u, instance.triangles.w | flags);
  worldTriangles[instance.triangles.x + triangle] = result;
  vec3 a = result.a.xyz, b = result.b.xyz, c = result.c.xyz;
  worldFaces[instance.triangles.x + triangle] =
      WorldFace(vec4(faceNormal(a, b, c), 0.0), vec4(angleAt(a, b, c), angleAt(b, c, a), angleAt(c, a, b), 0.0));
}
