// SDF objects in compute, with the same surfaces as their boxes have (sdf_box.frag.glsl): a tile of pixels lists the
// objects whose boxes reach into it, nearest first, and each pixel traces them until none can be nearer than what it hit.
// Compute writes no depth buffer: depths of all that is seen, meshes too, go into a texture of their own.
#include "lib/frame.glsl"
#include "lib/group_blocks.glsl"
#include "lib/octahedral.glsl"
#include "lib/packing.glsl"
#include "lib/sdf_hit.glsl"
#include "lib/tone_curve.glsl"

layout(local_size_x = SDF_TILE_WIDTH, local_size_y = SDF_TILE_HEIGHT) in;

layout(std430, binding = kScreenBoxBinding) readonly buffer ScreenBoxBlock { uvec4 boxCount; ScreenBox boxes[]; };
layout(binding = kDepthMeshUnit) uniform sampler2D depth_mesh;
#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[COUNTERS]; };
#endif
layout(binding = 0, rgba16_snorm) writeonly uniform image2D normal_world_oct;
layout(binding = 1, rgba8) writeonly uniform image2D albedo_srgb; // which no image can be of: encoded here
layout(binding = 2, rgba8) writeonly uniform image2D material;
layout(binding = 3, r11f_g11f_b10f) writeonly uniform image2D emission;
layout(binding = 4, r32ui) writeonly uniform uimage2D id;
layout(binding = 5, rg32ui) writeonly uniform uimage2D trace;
layout(binding = 6, r32f) writeonly uniform image2D depth_traced;

uniform bool isAlone; // there are no meshes, and nothing was cleared

const uint TILE_THREADS = SDF_TILE_WIDTH * SDF_TILE_HEIGHT;
const uint MOST_REACHING = max(TILE_THREADS + 512u, 1024u); // of one round
const uint NO_BOX = 0xffffffffu;

shared uvec2 reaching[MOST_REACHING]; // distance from the eye, float bits; number
shared uint nearestFirst[MOST_REACHING];
shared uint reachingCount;
shared uint farthestBits; // of what the tile's pixels see

// What a pixel sees. Of equal depths the first that would be drawn stays, as with boxes.
struct Seen {
  float depth;
  float t;     // the mesh, or a hit
  uint number; // of its box; NO_BOX: the mesh, or nothing
  bool backFace;
  uint steps;
  vec3 pointLevel;
};

// Lists those of the next boxes that reach into the tile before all that it sees.
// returns the first that was not asked
uint listBoxes(uint first, float farthest) {
  uint thread = gl_LocalInvocationIndex;
  uvec2 tile = uvec2(SDF_TILE_WIDTH, SDF_TILE_HEIGHT), tileFirst = gl_WorkGroupID.xy * tile, tileLast = tileFirst + tile - 1u;
  if (thread == 0u) reachingCount = 0u;
  barrier();
  while (first < boxCount.x && reachingCount + TILE_THREADS <= MOST_REACHING) {
    barrier(); // all have read the count
    uint number = first + thread;
    if (number < boxCount.x) {
      ScreenBox box = boxes[number];
      uvec2 low = uvec2(box.first & 0xffffu, box.first >> 16), high = uvec2(box.last & 0xffffu, box.last >> 16);
      bool isInTile = all(lessThanEqual(low, tileLast)) && all(greaterThanEqual(high, tileFirst));
      if (isInTile && box.nearest <= farthest) reaching[atomicAdd(reachingCount, 1u)] = uvec2(floatBitsToUint(box.nearest), number);
    }
    barrier();
    first += TILE_THREADS;
  }
  barrier();
  for (uint own = thread; own < reachingCount; own += TILE_THREADS) {
    uint rank = 0u;
    uvec2 it = reaching[own];
    for (uint i = 0u; i < reachingCount; ++i) {
      uvec2 other = reaching[i];
      rank += uint(other.x < it.x || (other.x == it.x && other.y < it.y));
    }
    nearestFirst[rank] = it.y;
  }
  barrier();
  return first;
}

void traceListed(vec3 originEye, vec3 directionWorld, inout Seen seen) {
  for (uint i = 0u; i < reachingCount; ++i) {
    uint number = nearestFirst[i];
    ScreenBox box = boxes[number];
    if (box.nearest > seen.t) break;
    SdfInstance instance = sdfInstances[box.entry & VISIBLE_INDEX_MASK];
    BrickAttributes attributes;
    SdfHit hit = traceObject(instance, levelOfEntry(instance, box.entry), originEye, directionWorld, 1.0001 * seen.t, attributes);
#ifdef COUNTERS_ON
    if (hit.steps > 0u) atomicAdd(counters[COUNTER_FRAGMENTS], 1u);
    atomicAdd(counters[COUNTER_STEPS], hit.steps);
    atomicAdd(counters[COUNTER_BRICK_READS], hit.brickReads);
    if (hit.hit) atomicAdd(counters[COUNTER_HITS], 1u);
    if (hit.steps >= frame.counts.z) atomicAdd(counters[COUNTER_OUT_OF_STEPS], 1u);
#endif
    if (!hit.hit) continue;
    float depth = depthOfPoint(originEye + hit.t * directionWorld);
    bool isFirst = depth == seen.depth && seen.number != NO_BOX && number < seen.number;
    if (depth > seen.depth || isFirst) seen = Seen(depth, hit.t, number, hit.backFace, hit.steps, hit.pointLevel);
  }
}

void writeSurface(ivec2 pixel, vec3 originEye, vec3 directionWorld, Seen seen) {
  uint entry = boxes[seen.number].entry, index = entry & VISIBLE_INDEX_MASK;
  SdfInstance instance = sdfInstances[index];
  SdfLevel level = levelOfEntry(instance, entry);
  vec2 normalOct = octahedralFromDirection(normalOfHit(instance, level, seen.pointLevel, seen.backFace, directionWorld));
  BrickAttributes attributes;
  readAttributes(level, seen.pointLevel, attributes);
  imageStore(normal_world_oct, pixel, vec4(normalOct, normalOct));
  imageStore(albedo_srgb, pixel, vec4(srgbFromLinear(attributes.colorAndCoverage.rgb), 1.0));
  imageStore(material, pixel, vec4(attributes.material.rgb, isUnlit(level, seen.pointLevel, attributes)));
  imageStore(emission, pixel, vec4(attributes.emission, 0.0));
  imageStore(id, pixel, uvec4(packId(index, KIND_SDF)));
  imageStore(trace, pixel, uvec4(traceOfHit(level, seen.pointLevel, seen.steps, entry), 0u, 0u));
}

void main() {
  ivec2 tile = ivec2(SDF_TILE_WIDTH, SDF_TILE_HEIGHT), pixel = ivec2(gl_WorkGroupID.xy) * tile + placeInBlocks(tile.x);
  bool isInPicture = all(lessThan(pixel, ivec2(frame.size.xy)));
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  Seen seen = Seen(0.0, 0.0, NO_BOX, false, 0u, vec3(0.0));
  if (isInPicture) {
    seen.depth = isAlone ? 0.0 : texelFetch(depth_mesh, pixel, 0).r;
    seen.t = rayParameterOfDepth(originEye, directionWorld, seen.depth);
  }
  for (uint first = 0u; first < boxCount.x;) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) farthestBits = 0u;
    barrier();
    atomicMax(farthestBits, floatBitsToUint(seen.t)); // positive floats are ordered as their bits
    barrier();
    first = listBoxes(first, uintBitsToFloat(farthestBits));
    if (isInPicture) traceListed(originEye, directionWorld, seen);
  }
  if (!isInPicture) return;
  imageStore(depth_traced, pixel, vec4(seen.depth));
  if (seen.number != NO_BOX)
    writeSurface(pixel, originEye, directionWorld, seen);
  else if (isAlone)
    imageStore(id, pixel, uvec4(0u));
}
