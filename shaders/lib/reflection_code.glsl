// What a reflected ray met, in one texel of four words, from the pass that traces to the one that shades; where none was
// traced, how much each of the four traced pixels around weighs.
#include "lib/frame.glsl"
#include "lib/octahedral.glsl"
#include "lib/work_list.glsl"

struct ReflectionHit {
  float t;       // metres along the ray to what it met, or passed nearest
  float free;    // share of the cone that nothing reaches into: 0 the ray ends there, 1 nothing is anywhere
  vec3 normal;   // of what it met, in the world
  uint node;     // of that, number + 1; 0: nobody knows
  bool isSeen;   // the picture shows it:
  ivec2 pixel;   // there
  vec4 visible;  // else: shares of the first lights that it sees
};

const uint REFLECTION_MOST_NODE = 0x3fffffu;
const uint REFLECTION_NOT_TRACED = 0xffffffffu; // no number is this far

// One of the four traced pixels around one: right of it where bit 0 of the corner is set, above where bit 1 is.
ivec2 tracedPlace(ivec2 pixel, int scale, int corner) {
  ivec2 last = (ivec2(frame.size.xy) - 1) / scale * scale;
  return min(pixel / scale * scale + ivec2(corner & 1, corner >> 1) * scale, last);
}

// weights  sum 1; all 0: the pixel mirrors the surroundings alone
uvec4 codeOfWeights(vec4 weights) {
  return uvec4(REFLECTION_NOT_TRACED, packUnorm2x16(weights.xy), packUnorm2x16(weights.zw), 0u);
}

bool isTracedCode(uvec4 code) { return code.x != REFLECTION_NOT_TRACED; }

vec4 weightsOfCode(uvec4 code) { return vec4(unpackUnorm2x16(code.y), unpackUnorm2x16(code.z)); }

uvec4 codeOfReflection(ReflectionHit hit) {
  uint node = hit.node > REFLECTION_MOST_NODE ? 0u : hit.node;
  return uvec4(floatBitsToUint(hit.t), packSnorm2x16(octahedralFromDirection(hit.normal)),
               node << 10 | uint(hit.isSeen) << 9 | uint(round(clamp(hit.free, 0.0, 1.0) * 255.0)),
               hit.isSeen ? uint(hit.pixel.y) << 16 | uint(hit.pixel.x) : packUnorm4x8(hit.visible));
}

ReflectionHit reflectionOfCode(uvec4 code) {
  return ReflectionHit(uintBitsToFloat(code.x), float(code.z & 0xffu) / 255.0, directionFromOctahedral(unpackSnorm2x16(code.y)),
                       code.z >> 10, (code.z >> 9 & 1u) != 0u, ivec2(code.w & 0xffffu, code.w >> 16), unpackUnorm4x8(code.w));
}

// Traced pixels as entries of a list of work.
const uint REFLECTION_GROUP = 32u; // threads, a pixel each: no warp waits for the rays of another

uint entryOfPixel(ivec2 pixel) { return uint(pixel.y) << 16 | uint(pixel.x); }

// Of this thread; false: there is none for it.
bool listedPixel(out ivec2 pixel) {
  uint number = numberOfGroup() * REFLECTION_GROUP + gl_LocalInvocationIndex;
  if (number >= workCount) return false;
  pixel = ivec2(work[number] & 0xffffu, work[number] >> 16);
  return true;
}
