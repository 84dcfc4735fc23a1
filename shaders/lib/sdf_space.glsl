// Between the grid of an SDF object and eye space. The object's place and the eye are subtracted from each other before
// anything is added, so that both may lie far from the origin.
#include "lib/frame.glsl"
#include "shared/sdf_params.h"

vec3 rowsTimesDirection(vec4 rows[3], vec3 direction) {
  return vec3(dot(rows[0].xyz, direction), dot(rows[1].xyz, direction), dot(rows[2].xyz, direction));
}

// Where sample 0 of the object's grid lies.
vec3 gridOriginEye(SdfInstance instance) {
  return vec3(instance.worldFromGrid[0].w, instance.worldFromGrid[1].w, instance.worldFromGrid[2].w) - frame.eyeWorld.xyz;
}

vec3 gridFromEye(SdfInstance instance, vec3 pointEye) {
  return rowsTimesDirection(instance.gridFromWorld, pointEye - gridOriginEye(instance));
}

vec3 eyeFromGrid(SdfInstance instance, vec3 pointGrid) {
  return rowsTimesDirection(instance.worldFromGrid, pointGrid) + gridOriginEye(instance);
}

// Ray parameters inside the box, from the near plane on.
vec2 boxRange(SdfInstance instance, vec3 originGrid, vec3 directionGrid, float tNear) {
  vec3 safe = mix(directionGrid, vec3(1e-20), equal(directionGrid, vec3(0.0)));
  vec3 a = (instance.boxMin.xyz - originGrid) / safe, b = (instance.boxMax.xyz - originGrid) / safe;
  vec3 lower = min(a, b), upper = max(a, b);
  return vec2(max(max(lower.x, lower.y), max(lower.z, tNear)), min(upper.x, min(upper.y, upper.z)));
}
