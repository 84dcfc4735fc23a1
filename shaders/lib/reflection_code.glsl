// What a reflected ray met, in one texel of four words, from the pass that traces to the one that shades.
#include "lib/octahedral.glsl"

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
const uvec4 REFLECTION_NOT_TRACED = uvec4(0xffffffffu, 0u, 0u, 0u); // t is no number

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
