// Pseudonormals after Baerentzen and Aanaes, Signed Distance Computation Using the Angle Weighted Pseudonormal, 2005. Of
// an edge: the sum of both faces' unit normals; of a vertex: the sum over its fan, weighted by the angle there. A group
// has triangles, whose edges it codes, or welded vertices, whose fans' corners it codes. Slivers, which have no normal,
// pass on those of their neighbours: with a corner in the middle of a neighbour's edge they stand for that neighbour.
#include "lib/octahedral.glsl"
#include "lib/triangle_distance.glsl"
#include "shared/world_field_params.h"
#include "shared/world_triangles_params.h"

layout(local_size_x = GATHER_TRIANGLES) in;

layout(std430, binding = kGatherTriangleBinding) buffer TriangleBlock { WorldTriangle worldTriangles[]; };
layout(std430, binding = kGatherFaceBinding) readonly buffer FaceBlock { WorldFace worldFaces[]; };
layout(std430, binding = kGatherInstanceBinding) readonly buffer InstanceBlock { WorldInstance worldInstances[]; };
layout(std430, binding = kGatherTopologyBinding) readonly buffer TopologyBlock { TopologyRow topology[]; };
layout(std430, binding = kGatherChunkBinding) readonly buffer ChunkBlock { GatherChunk chunks[]; };
layout(std430, binding = kGatherFanStartBinding) readonly buffer FanStartBlock { uint fanStarts[]; };
layout(std430, binding = kGatherFanCornerBinding) readonly buffer FanCornerBlock { uint fanCorners[]; };

uniform uint triangleChunks;
uniform uint chunkCount;

vec3 faceNormal(uint row) { return worldFaces[row].normal.xyz; }

uint codeOf(vec3 normal) {
  return packSnorm2x16(octahedralFromDirection(dot(normal, normal) > 0.0 ? normal : vec3(0.0, 0.0, 1.0)));
}

// Mirrored rows have b and c exchanged, so edge ab lies where ca was.
uint edgeInRow(uint edge, bool mirrored) { return mirrored ? 2u - edge : edge; }

vec3 normalBeyond(WorldInstance instance, uint triangle, uint edge) {
  uint beyond = topology[instance.triangles.z + triangle].neighbours[edge];
  return beyond == NO_NEIGHBOUR ? vec3(0.0) : faceNormal(instance.triangles.x + beyond);
}

uint longestEdge(uint row, bool mirrored) {
  vec3 ab = worldTriangles[row].b.xyz - worldTriangles[row].a.xyz;
  vec3 bc = worldTriangles[row].c.xyz - worldTriangles[row].b.xyz;
  vec3 ca = worldTriangles[row].a.xyz - worldTriangles[row].c.xyz;
  float ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
  return edgeInRow(ab2 >= bc2 && ab2 >= ca2 ? 0u : bc2 >= ca2 ? 1u : 2u, mirrored);
}

// A face's normal as it counts at one of its edges, or at a corner (edge 3): a sliver's longest edge sees through it to
// what lies at the other two, these and the corner between them to what lies at the longest.
vec3 normalSeenFrom(WorldInstance instance, bool mirrored, uint triangle, uint edge) {
  uint row = instance.triangles.x + triangle;
  vec3 own = faceNormal(row);
  if (dot(own, own) > 0.0) return own;
  uint longest = longestEdge(row, mirrored);
  if (edge != longest) return normalBeyond(instance, triangle, longest);
  return unitOrZero(normalBeyond(instance, triangle, (edge + 1u) % 3u) +
                    normalBeyond(instance, triangle, (edge + 2u) % 3u));
}

uint edgeTowards(WorldInstance instance, uint triangle, uint beyond) {
  uvec4 back = topology[instance.triangles.z + beyond].neighbours;
  return back.x == triangle ? 0u : back.y == triangle ? 1u : 2u;
}

void codeEdges(WorldInstance instance, bool mirrored, uint triangle) {
  uint row = instance.triangles.x + triangle;
  uvec4 beyond = topology[instance.triangles.z + triangle].neighbours;
  for (uint edge = 0u; edge < 3u; ++edge) {
    vec3 own = normalSeenFrom(instance, mirrored, triangle, edge), sum = own;
    if (beyond[edge] != NO_NEIGHBOUR)
      sum += normalSeenFrom(instance, mirrored, beyond[edge], edgeTowards(instance, triangle, beyond[edge]));
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
    sum += normalSeenFrom(instance, mirrored, fanCorners[i] >> 2u, 3u) * worldFaces[row].angles[corner];
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
