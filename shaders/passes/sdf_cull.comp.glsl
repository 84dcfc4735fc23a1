// Chooses the SDF objects of a frame and how each is drawn. One work group walks over all instances in order, so that
// the lists keep the scene's order and a frame is the same every time it is drawn.
//
// Commands: 0 draws the three faces that look at the eye (18 vertices), 1 the far faces of those whose box the near
// plane or the eye may cut (36 vertices).
#include "lib/sdf_space.glsl"

layout(local_size_x = 256) in;

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };
layout(std430, binding = kPassBufferABinding) writeonly buffer CommandBlock { BoxCommand commands[BOX_COMMANDS]; };
layout(std430, binding = kPassBufferBBinding) writeonly buffer VisibleBlock { uint visible[]; }; // two halves of counts.x

uniform bool reverseOrder; // draws the same objects back to front of the list; the picture must not change

shared uvec2 scan[256];

// Whole box outside of one plane of the frustum (the far plane is left out: boxes beyond it cost nothing).
bool isOutside(SdfInstance instance) {
  uint outside = 0x1fu;
  for (uint corner = 0u; corner < 8u; ++corner) {
    vec3 pick = vec3(corner & 1u, (corner >> 1) & 1u, corner >> 2);
    vec3 pointEye = eyeFromGrid(instance, mix(instance.boxMin.xyz, instance.boxMax.xyz, pick));
    vec4 clip = frame.clipFromEye * vec4(pointEye, 1.0);
    uint code = uint(clip.x < -clip.w) | uint(clip.x > clip.w) << 1 | uint(clip.y < -clip.w) << 2 |
                uint(clip.y > clip.w) << 3 | uint(clip.z > clip.w) << 4;
    outside &= code;
  }
  return outside != 0u;
}

// The eye and the near rectangle, bounded by a box in grid space, meet the object's box. May say yes too often: far
// faces draw the right picture as well.
bool isCutByNearPlane(SdfInstance instance) {
  vec3 lower = vec3(3.4e38), upper = vec3(-3.4e38);
  for (int corner = 0; corner < 4; ++corner) {
    vec2 ndc = vec2((corner & 1) * 2 - 1, (corner >> 1) * 2 - 1);
    vec3 originEye, directionWorld;
    viewRay(ndc, originEye, directionWorld);
    vec3 nearGrid = gridFromEye(instance, originEye + rayParameterOfNear(directionWorld) * directionWorld);
    vec3 eyeGrid = gridFromEye(instance, originEye);
    lower = min(lower, min(nearGrid, eyeGrid));
    upper = max(upper, max(nearGrid, eyeGrid));
  }
  // A tenth of a voxel covers the rounding of the transforms.
  return all(lessThanEqual(lower - 0.1, instance.boxMax.xyz)) && all(greaterThanEqual(upper + 0.1, instance.boxMin.xyz));
}

// The level whose voxel, at the box's nearest point, is at most half a pixel: at a whole one, walls that are thinner than
// a voxel break up while they still are to be seen.
uint levelFor(SdfInstance instance) {
  if (frame.counts.y > 0u) return min(frame.counts.y - 1u, uint(instance.ids.z) - 1u);
  float nearest = frame.eyeWorld.w;
  if (frame.projection.z < 0.5) {
    vec3 eyeGrid = gridFromEye(instance, vec3(0.0));
    vec3 closestGrid = clamp(eyeGrid, instance.boxMin.xyz, instance.boxMax.xyz);
    nearest = max(nearest, length(eyeFromGrid(instance, closestGrid)));
  } else {
    nearest = 1.0;
  }
  float pixelWorld = 2.0 * nearest / (frame.projection.y * float(frame.size.y));
  float level = floor(log2(pixelWorld / instance.boxMin.w)) - 1.0;
  return uint(clamp(level, 0.0, float(instance.ids.z - 1)));
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  uvec2 totals = uvec2(0u); // facing, inside
  for (uint first = 0u; first < frame.counts.x; first += 256u) {
    uint slot = first + thread;
    uvec2 mine = uvec2(0u);
    uint entry = 0u;
    if (slot < frame.counts.x) {
      uint index = reverseOrder ? frame.counts.x - 1u - slot : slot;
      SdfInstance instance = sdfInstances[index];
      if (!isOutside(instance)) {
        bool inside = isCutByNearPlane(instance);
        mine = inside ? uvec2(0u, 1u) : uvec2(1u, 0u);
        entry = index | levelFor(instance) << VISIBLE_LEVEL_SHIFT | (inside ? VISIBLE_INSIDE : 0u);
      }
    }
    scan[thread] = mine;
    barrier();
    for (uint reach = 1u; reach < 256u; reach <<= 1) {
      uvec2 before = thread >= reach ? scan[thread - reach] : uvec2(0u);
      barrier();
      scan[thread] += before;
      barrier();
    }
    uvec2 place = totals + scan[thread] - mine;
    if (mine.x != 0u) visible[place.x] = entry;
    if (mine.y != 0u) visible[frame.counts.x + place.y] = entry;
    totals += scan[255];
    barrier();
  }
  if (thread == 0u) {
    commands[BOX_COMMAND_FACING] = BoxCommand(18u, totals.x, 0u, 0u);
    commands[BOX_COMMAND_NEAR_PLANE] = BoxCommand(36u, totals.y, 0u, frame.counts.x);
  }
}
