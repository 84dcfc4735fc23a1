// How much of an object a ray crosses (thesis 7.4): on from a point of its surface, through its own bricks alone.
#include "lib/brick_trace.glsl"
#include "lib/sdf_space.glsl"

const int MOST_CROSSINGS = 16; // of the surface
const float PAST_CROSSING_VOXELS = 1e-2;

uint insideSteps = 0u; // of this thread

// Metres of the ray that lie inside, all stretches together; until the object's box ends.
//
// direction  of length one in the world, carried to grid space
float metresInside(SdfInstance instance, SdfLevel level, vec3 originGrid, vec3 directionGrid, uint maxSteps) {
  float end = boxRange(instance, originGrid, directionGrid, 0.0).y;
  float past = PAST_CROSSING_VOXELS / (length(directionGrid) * level.scale.x);
  float sum = 0.0, entered = 0.0, t = past;
  bool isInside = fieldDistance(level, (originGrid + t * directionGrid) * level.scale.x) < 0.0;
  uint steps = 0u;
  for (int i = 0; i < MOST_CROSSINGS && t < end; ++i) {
    TraceHit hit = traceBricks(level, originGrid, directionGrid, vec2(t, end), true, maxSteps - steps);
    steps += hit.steps;
    if (!hit.hit) break;
    if (hit.backFace) sum += hit.t - entered; // of a surface left twice over the second stretch is none
    entered = hit.t;
    isInside = !hit.backFace;
    t = hit.t + past;
  }
  insideSteps += steps;
  return sum + (isInside ? max(end - entered, 0.0) : 0.0);
}
