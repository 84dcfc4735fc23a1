// Corners of the triangles of what moved, where they stand in anchored space. Welded corners come out with the same
// bits, because the same vertices go through the same operations.
#include "lib/finite.glsl"
#include "shared/mesh_params.h"
#include "shared/world_field_params.h"
#include "shared/world_triangles_params.h"

layout(local_size_x = GATHER_TRIANGLES) in;

layout(std430, binding = kGatherTriangleBinding) writeonly buffer TriangleBlock { WorldTriangle worldTriangles[]; };
layout(std430, binding = kGatherInstanceBinding) readonly buffer InstanceBlock { WorldInstance worldInstances[]; };
layout(std430, binding = kGatherTopologyBinding) readonly buffer TopologyBlock { TopologyRow topology[]; };
layout(std430, binding = kGatherChunkBinding) readonly buffer ChunkBlock { GatherChunk chunks[]; };
layout(std430, binding = kGatherVertexBinding) readonly buffer VertexBlock { MeshVertex vertices[]; };

uniform uint chunkCount;

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
}
