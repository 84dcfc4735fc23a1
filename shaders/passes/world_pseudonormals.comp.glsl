// Pseudonormals after Baerentzen and Aanaes, Signed Distance Computation Using the Angle Weighted Pseudonormal, 2005. Of
// an edge: the sum of both faces' unit normals; of a vertex: the sum over its fan, weighted by the angle there. A group
// has triangles, whose edges it codes, or welded vertices, whose fans' corners it codes. Slivers, which have no normal,
// pass on those of their neighbours: with a corner in the middle of a neighbour's edge they stand for that neighbour. Sheets
// have none: nobody asks on which side of one a point lies.
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

// Cosine between the normals of two faces below which their edge is looked at closely.
const float FOLDED_COSINE = -0.6;
// Of the edge's length: how far before it. Far enough for floats, and nearer than what else lies there.
const float PROBE_SHARE = 0.02;
// Least solid angle that outweighs the edge's own normals; a plane right behind the probe takes up 2 pi.
const float SURE_SOLID_ANGLE = 2.5;
// Of two normals' sum: faces as close as this leave nothing between them, and its direction is that of rounding.
const float FLAT_SUM = 0.001;
const uint MOST_OF_FAN = 64u;

uniform uint triangleChunks;
uniform uint chunkCount;

vec3 faceNormal(uint row) { return worldFaces[row].normal.xyz; }

uint codeOf(vec3 normal) {
  return packSnorm2x16(octahedralFromDirection(dot(normal, normal) > 0.0 ? normal : vec3(0.0, 0.0, 1.0)));
}

// Mirrored rows have b and c exchanged, so edge ab lies where ca was.
uint edgeInRow(uint edge, bool mirrored) { return mirrored ? 2u - edge : edge; }

uint cornerInRow(uint corner, bool mirrored) { return mirrored && corner > 0u ? 3u - corner : corner; }

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

vec3 cornerOf(uint row, uint corner) {
  return corner == 0u   ? worldTriangles[row].a.xyz
         : corner == 1u ? worldTriangles[row].b.xyz
                        : worldTriangles[row].c.xyz;
}

// Solid angle of a triangle seen from the origin, negative from its outside (Van Oosterom and Strackee 1983).
float solidAngle(vec3 a, vec3 b, vec3 c) {
  float la = length(a), lb = length(b), lc = length(c);
  float y = dot(a, cross(b, c)), x = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return y != 0.0 || x != 0.0 ? 2.0 * atan(y, x) : 0.0;
}

// Of the faces around the vertex where `edge` of `triangle` begins, but for the one beyond that edge.
// probe  from the corner `origin`
float fanSolidAngle(WorldInstance instance, vec3 origin, vec3 probe, uint triangle, uint edge) {
  uint last = topology[instance.triangles.z + triangle].neighbours[edge];
  float sum = 0.0;
  for (uint i = 0u; i < MOST_OF_FAN; ++i) {
    uint row = instance.triangles.x + triangle;
    sum += solidAngle(cornerOf(row, 0u) - origin - probe, cornerOf(row, 1u) - origin - probe,
                      cornerOf(row, 2u) - origin - probe);
    uint beyond = topology[instance.triangles.z + triangle].neighbours[(edge + 2u) % 3u];
    if (beyond == NO_NEIGHBOUR || beyond == last) break;
    edge = edgeTowards(instance, triangle, beyond), triangle = beyond;
  }
  return sum;
}

// Of an edge whose faces fold onto each other. Where a skin is pinched or a mesh was thinned out such a fold may be a
// flap turned inside out, or one without inside; the sum of its normals then points into the surface that it lies on,
// for all that is nearest to the edge, however far away. So from right before the edge the faces around both its ends
// are asked: do they show their outside? Other faces may go through the fold, so each part of the edge is asked for
// itself.
uint foldedCode(WorldInstance instance, bool mirrored, uint triangle, uint edge, vec3 own, vec3 other) {
  uint row = instance.triangles.x + triangle, place = edgeInRow(edge, mirrored);
  uint beyond = topology[instance.triangles.z + triangle].neighbours[edge];
  uint edgeBack = edgeTowards(instance, triangle, beyond);
  vec3 origin = cornerOf(row, place), along = cornerOf(row, (place + 1u) % 3u) - origin;
  vec3 before = unitOrZero(cross(along, own - other)); // away from both faces, half-way between them
  float opening = dot(own + other, before);            // of a ridge positive, of a groove negative
  uint outside = 0u;
  for (uint part = 0u; part < WORLD_TRIANGLE_FOLD_PARTS; ++part) {
    float share = (float(part) + 0.5) / float(WORLD_TRIANGLE_FOLD_PARTS);
    vec3 probe = share * along + PROBE_SHARE * length(along) * before;
    float angle = fanSolidAngle(instance, origin, probe, triangle, edge) +
                  fanSolidAngle(instance, origin, probe, beyond, edgeBack);
    bool isAsked = abs(angle) > SURE_SOLID_ANGLE || abs(opening) < FLAT_SUM;
    if (isAsked ? angle < 0.0 : opening > 0.0) outside |= 1u << part;
  }
  return outside << 16u | WORLD_TRIANGLE_FOLDED;
}

uint edgeCode(WorldInstance instance, bool mirrored, uint triangle, uint edge) {
  uint beyond = topology[instance.triangles.z + triangle].neighbours[edge];
  vec3 own = normalSeenFrom(instance, mirrored, triangle, edge);
  if (beyond == NO_NEIGHBOUR) return codeOf(own);
  vec3 other = normalSeenFrom(instance, mirrored, beyond, edgeTowards(instance, triangle, beyond));
  if (dot(own, other) < FOLDED_COSINE) return foldedCode(instance, mirrored, triangle, edge, own, other);
  vec3 sum = own + other;
  return codeOf(dot(sum, sum) > 1e-12 ? sum : own);
}

void codeEdges(WorldInstance instance, bool mirrored, uint triangle) {
  uint row = instance.triangles.x + triangle;
  if ((worldTriangles[row].codes.w & WORLD_TRIANGLE_CLOSED) == 0u) return; // sheets have no sides
  for (uint edge = 0u; edge < 3u; ++edge) {
    uint code = edgeCode(instance, mirrored, triangle, edge);
    uint place = edgeInRow(edge, mirrored);
    if (place == 0u) worldTriangles[row].codes.x = code;
    else if (place == 1u) worldTriangles[row].codes.y = code;
    else worldTriangles[row].codes.z = code;
  }
}

// What a corner of a fan gives: the face's normal, and the angle there.
vec4 faceOfFan(WorldInstance instance, bool mirrored, uint fanCorner) {
  WorldFace face = worldFaces[instance.triangles.x + (fanCorner >> 2u)];
  uint corner = cornerInRow(fanCorner & 3u, mirrored);
  return vec4(face.normal.xyz, corner == 0u ? face.angles.x : corner == 1u ? face.angles.y : face.angles.z);
}

bool isSliver(vec4 face) { return dot(face.xyz, face.xyz) == 0.0; }

// The four corners of a fan from `first` on, as faceOfFan; nothing beyond the fan's end. Together, because a fan of
// hundreds would wait for one after the other.
mat4 facesOfFan(WorldInstance instance, bool mirrored, uint first, uint end) {
  uvec4 at = min(uvec4(first) + uvec4(0u, 1u, 2u, 3u), uvec4(end - 1u));
  uvec4 corners = uvec4(fanCorners[at.x], fanCorners[at.y], fanCorners[at.z], fanCorners[at.w]);
  vec4 a = faceOfFan(instance, mirrored, corners.x), b = faceOfFan(instance, mirrored, corners.y);
  vec4 c = faceOfFan(instance, mirrored, corners.z), d = faceOfFan(instance, mirrored, corners.w);
  if (isSliver(a)) a.xyz = normalSeenFrom(instance, mirrored, corners.x >> 2u, 3u);
  if (isSliver(b)) b.xyz = normalSeenFrom(instance, mirrored, corners.y >> 2u, 3u);
  if (isSliver(c)) c.xyz = normalSeenFrom(instance, mirrored, corners.z >> 2u, 3u);
  if (isSliver(d)) d.xyz = normalSeenFrom(instance, mirrored, corners.w >> 2u, 3u);
  vec4 isHere = vec4(lessThan(uvec4(first) + uvec4(0u, 1u, 2u, 3u), uvec4(end)));
  return mat4(a * vec4(vec3(1.0), isHere.x), b * vec4(vec3(1.0), isHere.y), c * vec4(vec3(1.0), isHere.z),
              d * vec4(vec3(1.0), isHere.w));
}

void codeVertex(WorldInstance instance, bool mirrored, uint vertex) {
  uint begin = fanStarts[instance.vertices.z + vertex], end = fanStarts[instance.vertices.z + vertex + 1u];
  vec3 sum = vec3(0.0);
  for (uint first = begin; first < end; first += 4u) {
    mat4 faces = facesOfFan(instance, mirrored, first, end);
    sum += faces[0].xyz * faces[0].w + faces[1].xyz * faces[1].w + faces[2].xyz * faces[2].w + faces[3].xyz * faces[3].w;
  }
  uint code = codeOf(sum);
  for (uint i = begin; i < end; ++i) {
    uint row = instance.triangles.x + (fanCorners[i] >> 2u), corner = cornerInRow(fanCorners[i] & 3u, mirrored);
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
