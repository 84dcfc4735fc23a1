// The longest way that any pixel of a tile smears; a group a tile.
#include "lib/motion_blur.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0, rg16f) writeonly uniform image2D motion_tiles;

shared vec2 longest[MOTION_TILE * MOTION_TILE];

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  uint own = gl_LocalInvocationIndex;
  longest[own] = all(lessThan(pixel, ivec2(frame.size.xy))) ? smearAt(pixel) : vec2(0.0);
  for (uint width = uint(MOTION_TILE * MOTION_TILE / 2); width > 0u; width /= 2u) {
    barrier();
    vec2 other = own < width ? longest[own + width] : vec2(0.0);
    if (dot(other, other) > dot(longest[own], longest[own])) longest[own] = other;
  }
  if (own == 0u) imageStore(motion_tiles, ivec2(gl_WorkGroupID.xy), vec4(longest[0], 0.0, 0.0));
}
