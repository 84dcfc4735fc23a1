// SDF objects join the field: the minimum of the meshes' value and the values of all objects that reach a tile.
#include "lib/field_grid.glsl"
#include "lib/field_objects.glsl"

layout(local_size_x = 128) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldNodeBinding) buffer NodeBlock { uint nodes[]; };
layout(binding = 0, r16f) uniform image3D distances[MOST_CASCADES];

uniform uint listLength;

const uint MOST_OBJECTS = 128u; // of one round
const int TEXELS_OF_A_THREAD = int(FIELD_TILE_TEXELS) / 128;

shared uint reaching[MOST_OBJECTS];
shared uint reachingCount;
shared uint farthestBits; // largest value in the tile, metres

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  int thread = int(gl_LocalInvocationIndex);
  float range = cascade.texel.z * cascade.texel.x;
  if (thread == 0) farthestBits = 0u;
  barrier();

  float metres[TEXELS_OF_A_THREAD];
  uint owners[TEXELS_OF_A_THREAD];
  for (int i = 0; i < TEXELS_OF_A_THREAD; ++i) {
    ivec3 lattice = tile.firstTexel + cubeIndex(i * 128 + thread, int(FIELD_TILE));
    metres[i] = imageLoad(distances[tile.cascade], lattice & (cascade.window.w - 1)).r * cascade.texel.x;
    owners[i] = nodes[texelWord(cascade, lattice)];
  }
  // In rounds; objects farther than the tile's largest value can change nothing.
  vec3 tileCenter = field.anchor.xyz + (vec3(tile.firstTexel) + 0.5 * float(FIELD_TILE)) * cascade.texel.x;
  float halfDiagonal = 0.8660255 * float(FIELD_TILE - 1u) * cascade.texel.x;
  bool isChanged = false;
  for (uint first = 0u; first < field.counts.z; first += MOST_OBJECTS) {
    float farthest = 0.0;
    for (int i = 0; i < TEXELS_OF_A_THREAD; ++i) farthest = max(farthest, metres[i]);
    atomicMax(farthestBits, floatBitsToUint(farthest)); // positive floats are ordered as their bits
    if (thread == 0) reachingCount = 0u;
    barrier();
    float most = uintBitsToFloat(farthestBits);
    uint object = first + uint(thread);
    if (object < field.counts.z && boxDistance(sdfInstances[object], tileCenter) - halfDiagonal < most)
      reaching[atomicAdd(reachingCount, 1u)] = object;
    barrier();
    // The order of the list may differ from run to run; the minimum, with ties to the lower node, does not.
    for (uint r = 0u; r < reachingCount; ++r) {
      SdfInstance instance = sdfInstances[reaching[r]];
      int firstLevel = firstLevelFor(instance, cascade.texel.x);
      uint node = uint(instance.ids.x) + 1u;
      for (int i = 0; i < TEXELS_OF_A_THREAD; ++i) {
        ivec3 lattice = tile.firstTexel + cubeIndex(i * 128 + thread, int(FIELD_TILE));
        vec3 point = field.anchor.xyz + texelCenter(cascade, lattice);
        if (metres[i] > 0.0 && boxDistance(instance, point) > metres[i]) continue;
        float distance = max(objectDistance(instance, point, firstLevel), -range);
        uint meshInside = owners[i] & FIELD_NODE_INSIDE, owner = owners[i] & ~FIELD_NODE_INSIDE;
        if (distance < metres[i] || (distance == metres[i] && distance < range && node < owner)) {
          metres[i] = distance;
          owners[i] = node | meshInside;
          isChanged = true;
        }
      }
    }
    barrier();
    if (thread == 0) farthestBits = 0u;
    barrier();
  }
  if (!isChanged) return;
  for (int i = 0; i < TEXELS_OF_A_THREAD; ++i) {
    ivec3 lattice = tile.firstTexel + cubeIndex(i * 128 + thread, int(FIELD_TILE));
    nodes[texelWord(cascade, lattice)] = owners[i];
    imageStore(distances[tile.cascade], lattice & (cascade.window.w - 1), vec4(metres[i] * cascade.texel.y));
  }
}
