// Boxes of SDF objects without a vertex buffer: six vertices a face, the object from an instance attribute.
// Facing objects draw the three faces on the eye's side; where eye or near plane are inside, the far faces, pushed to
// the near plane, so that the fragment's depth bounds every hit behind it.
#include "lib/sdf_space.glsl"

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };

layout(location = 0) in uint visibleEntry;

layout(location = 0) flat out uint entry;

// Corners of a face's two triangles in its own plane.
const vec2 kFaceCorners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

void main() {
  entry = visibleEntry;
  SdfInstance instance = sdfInstances[visibleEntry & VISIBLE_INDEX_MASK];
  bool inside = (visibleEntry & VISIBLE_INSIDE) != 0u;

  // What the eye sees along each axis of grid space. Orthographic: the eye lies infinitely far against the view.
  vec3 eyeGrid;
  vec3 boxMin = instance.boxMin.xyz, boxMax = instance.boxMax.xyz;
  if (frame.projection.z > 0.5) {
    vec3 towardsEyeWorld = frame.worldFromView[2].xyz;
    vec3 towardsEyeGrid = rowsTimesDirection(instance.gridFromWorld, towardsEyeWorld);
    eyeGrid = 0.5 * (boxMin + boxMax) + sign(towardsEyeGrid) * (boxMax - boxMin);
  } else {
    eyeGrid = gridFromEye(instance, vec3(0.0));
  }

  int face = gl_VertexID / 6;
  int axis = face % 3;
  bool upperSide;
  bool visible;
  if (inside) {
    upperSide = face >= 3;
    // Far faces are those that the eye sees from within.
    visible = upperSide ? eyeGrid[axis] <= boxMax[axis] : eyeGrid[axis] >= boxMin[axis];
  } else {
    upperSide = eyeGrid[axis] > boxMax[axis];
    visible = upperSide || eyeGrid[axis] < boxMin[axis];
  }
  vec2 corner = kFaceCorners[gl_VertexID % 6];
  vec3 pick;
  pick[axis] = upperSide ? 1.0 : 0.0;
  pick[(axis + 1) % 3] = corner.x;
  pick[(axis + 2) % 3] = corner.y;
  vec3 pointEye = eyeFromGrid(instance, mix(boxMin, boxMax, pick));
  gl_Position = visible ? frame.clipFromEye * vec4(pointEye, 1.0) : vec4(2.0, 2.0, 0.5, 1.0);
  if (inside && visible) gl_Position.z = gl_Position.w;
}
