// Where the boxes of the visible SDF objects lie on the picture, and how near they begin: what tiles choose by.
#include "lib/sdf_space.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };
layout(std430, binding = kPassBufferABinding) readonly buffer CommandBlock { BoxCommand commands[BOX_COMMANDS]; };
layout(std430, binding = kPassBufferBBinding) readonly buffer VisibleBlock { uint visible[]; }; // two halves of counts.x
layout(std430, binding = kScreenBoxBinding) writeonly buffer ScreenBoxBlock { uvec4 boxCount; ScreenBox boxes[]; };

// All of the picture where a corner lies behind the eye.
void pixelsOfBox(SdfInstance instance, out vec2 low, out vec2 high) {
  vec2 size = vec2(frame.size.xy);
  low = size;
  high = vec2(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    vec3 pick = vec3(corner & 1, corner >> 1 & 1, corner >> 2);
    vec4 clip = frame.clipFromEye * vec4(eyeFromGrid(instance, mix(instance.boxMin.xyz, instance.boxMax.xyz, pick)), 1.0);
    if (clip.w < 0.5 * frame.eyeWorld.w) {
      low = vec2(0.0);
      high = size;
      return;
    }
    vec2 pixel = (clip.xy / clip.w * 0.5 + 0.5) * size;
    low = min(low, pixel);
    high = max(high, pixel);
  }
}

void main() {
  const float SLACK_PIXELS = 0.05, SLACK = 0.9999; // for rounding
  uint facing = commands[BOX_COMMAND_FACING].instances, count = facing + commands[BOX_COMMAND_NEAR_PLANE].instances;
  uint number = gl_GlobalInvocationID.x;
  if (number == 0u) boxCount = uvec4(count, 0u, 0u, 0u);
  if (number >= count) return;
  uint entry = visible[number < facing ? number : frame.counts.x + number - facing]; // in the order of the draws
  SdfInstance instance = sdfInstances[entry & VISIBLE_INDEX_MASK];
  vec2 low, high;
  pixelsOfBox(instance, low, high);
  uvec2 first = uvec2(clamp(low - SLACK_PIXELS, vec2(0.0), vec2(frame.size.xy))), last = uvec2(clamp(high + SLACK_PIXELS, vec2(0.0), vec2(frame.size.xy)));
  float nearest = 0.0;
  if (frame.projection.z < 0.5) {
    vec3 eyeGrid = gridFromEye(instance, vec3(0.0));
    nearest = SLACK * instance.boxMax.w * distance(eyeGrid, clamp(eyeGrid, instance.boxMin.xyz, instance.boxMax.xyz));
  }
  boxes[number] = ScreenBox(first.x | first.y << 16, last.x | last.y << 16, entry, nearest);
}
