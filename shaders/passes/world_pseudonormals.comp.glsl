// Pseudonormals after Baerentzen and Aanaes, Signed Distance Computation Using the Angle Weighted Pseudonormal, 2005. Of
// an edge: the sum of both faces' unit normals; of a vertex: the sum over its fan, weighted by the angle there. A group
// has triangles, whose edges it codes, or welded vertices, whose fans' corners it codes.
#include "lib/octahedral.glsl"
#include "lib/triangle_distance.glsl"
#include "shared/world_field_params.h"
#include "shared/world_triangles_params.h"

layout(local_size_x = GATHER_TRIANGLES) in;

layout(std430, binding = kGatherTriangleBinding) buffer TriangleBlock { WorldTriangle worldTriangles[]; };
layout(std430, binding = kGatherInstanceBinding) readonly buffer InstanceBlock { WorldInstance worldInstances[]; };
layout(std430, binding = kGatherTopologyBinding) readonly buffer TopologyBlock { TopologyRow topology[]; };
layout(std430, binding = kGatherChunkBinding) readonly buffer ChunkBlock { GatherChunk chunks[]; };
layout(std430, binding = kGatherFanStartBinding) readonly buffer FanStartBlock { uint fanStarts[]; };
layout(std430, binding = kGatherFanCornerBinding) readonly buffer FanCornerBlock { uint fanCorners[]; };

uniform uint triangleChunks;
uniform uint chunkCount;

vec3 cornerOf(uint row, uint corner) {
  return corner == 0u   ? worldTriangles[row].a.xyz
         : corner == 1u ? worldTriangles[row].b.xyz
                        : worldTriangles[row].c.xyz;
}

// Unit, or zero where the triangle has no area.
vec3 faceNormal(uint row) {
  return unitOrZero(areaNormal(worldTriangles[row].a.xyz, worldTriangles[row].b.xyz, worldTriangles[row].c.xyz));
}

uint codeOf(vec3 normal) {
  return packSnorm2x16(octahedralFromDirection(dot(normal, normal) > 0.0 ? normal : vec3(0.0, 0.0, 1.0)));
}

// Mirrored rows have b and c exchanged, so edge ab lies where ca was.
uint edgeInRow(uint edge, bool mirrored) { return mirrored ? 2u - edge : edge; }

void codeEdges(WorldInstance instance, bool mirrored, uint triangle) {
  uint row = instance.triangles.x + triangle;
  uvec4 beyond = topology[instance.triangles.z + triangle].neighbours;
  vec3 own = faceNormal(row);
  for (uint edge = 0u; edge < 3u; ++edge) {
    vec3 sum = own;
    if (beyond[edge] != NO_NEIGHBOUR) sum += faceNormal(instance.triangles.x + beyond[edge]);
    // Two faces that fold onto each other leave nothing between them; then any side is as good.
    uint code = codeOf(dot(sum, sum) > 1e-12 ? sum : own);
    uint place = edgeInRow(edge, mirrored);
    if (place == 0u) worldTriangles[row].codes.x = code;
    else if (place == 1u) worldTriangles[row].codes.y = code;
    else worldTriangles[row].codes.z = code;
  }
}

void codeVertex(WorldInstance instance, bool mirrored, uint vertex) {
  uint begin = fanStarts[instance.vertices.z + vertex], end = fanStarts[instance.vertices.z + vertex + 1u];
  vec3 sum = vec3(0.0);
  for (uint i = begin; i < end; ++i) {
    uint row = instance.triangles.x + (fanCorners[i] >> 2u), corner = fanCorners[i] & 3u;
    if (mirrored && corner > 0u) corner = 3u - corner;
    vec3 tip = cornerOf(row, corner);
    vec3 first = cornerOf(row, (corner + 1u) % 3u) - tip, second = cornerOf(row, (corner + 2u) % 3u) - tip;
    vec3 normal = faceNormal(row);
    if (dot(normal, normal) > 0.0) sum += normal * atan(length(cross(first, second)), dot(first, second));
  }
  uint code = codeOf(sum);
  for (uint i = begin; i < end; ++i) {
    uint row = instance.triangles.x + (fanCorners[i] >> 2u), corner = fanCorners[i] & 3u;
    if (mirrored && corner > 0u) corner = 3u - corner;
    if (corner == 0u) worldTriangles[row].a.w = uintBitsToFloat(code);
    else if (corner == 1u) worldTriangles[row].b.w = uintBitsToFloat(code);
    else worldTriangles[row].c.w = uintBitsToFloat(code);
  }
}

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= chunkCount) return;
  GatherChunk chunk = chunks[number];
  if (gl_LocalInvocationID.x >= chunk.count) return;
  WorldInstance instance = worldInstances[chunk.instance];
  bool mirrored = (instance.vertices.w & WORLD_INSTANCE_MIRRORED) != 0u;
  uint index = chunk.first + gl_LocalInvocationID.x;
  if (number < triangleChunks) codeEdges(instance, mirrored, index);
  else codeVertex(instance, mirrored, index);
}
