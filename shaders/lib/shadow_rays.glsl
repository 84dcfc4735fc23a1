// The stage RAY of a march for soft shadows: narrow rays to parts of the light, one after the other, from where the cone is
// first touched.
#include "lib/shadow_march.glsl"

const uint MOST_RAY_READS = 64u;
// Of a penumbra's radius for each ray: where steps are narrower than this none are seen, and sharing would only blur.
const float SHARED_PIXELS = 1.0;
const int LEAST_SURE_RAYS = 3;
// Slower than this falls what is passed; and so far behind the front of a wall lies a sheet's middle.
const float NEAR_GRAINS = 2.5, LEAST_FALL = 0.25, WITHIN_GRAINS = 0.5;
const float FADE = 0.5; // of the distance between rays, about
const float LEAD = 8.0; // see stepRay

bool isMeanOfCell = false; // what was marched last, see partOfLight

// The next ray that leaves the surface, every second one first: where all of these see the light, or none does, so do
// the others. Without one the march is done.
void beginRay(inout March march, ShadowCone cone, int cell) {
  int first = (march.rays + 1) / 2;
  for (; march.ray < march.rays; ++march.ray) {
    int i = march.ray;
    if (i == first && first >= LEAST_SURE_RAYS && (march.sum == float(first) || (ENDS_DARK && march.sum == 0.0))) {
      finish(march, min(march.sum, 1.0));
      return;
    }
    int ray = i < first ? 2 * i : 2 * (i - first) + 1;
    vec2 part = isMeanOfCell ? partOfLight(cone, ray, march.rays, cell) : partOfLight(cone, ray, march.rays);
    march.across = part.x * cone.right + part.y * cone.up;
    march.pace = inversesqrt(dot(cone.axis + march.across, cone.axis + march.across));
    float horizon = dot(cone.normal, cone.axis + march.across) * march.pace;
    march.free = clamp(0.5 + horizon / max(march.width, 1e-4), 0.0, 1.0);
    if (march.free > 0.0) {
      begin(march, RAY, march.start);
      march.sure = march.start;
      march.ball = 3.4e38;
      return;
    }
  }
  finish(march, march.sum / float(march.rays));
}

void endRay(inout March march, ShadowCone cone, float free, int cell) {
  march.sum += free;
  ++march.ray;
  beginRay(march, cone, cell);
}

void beginRays(inout March march, ShadowCone cone, float start, float softness, int cell) {
  if (cone.spread == 0.0) march.rays = 1;
  isMeanOfCell = cone.spread * start > SHARED_PIXELS * float(march.rays) * cone.pixel;
  march.width = softness * FADE * inversesqrt(float(march.rays)) * cone.spread;
  // Of a rectangle, of the disk of its area: 4 a b / pi.
  if (cone.isRectangle) march.width *= sqrt(1.2732395 * length(cone.right) * length(cone.up)) / cone.spread;
  march.start = start;
  march.ray = 0;
  march.sum = 0.0;
  march.fall = 0.0;
  beginRay(march, cone, cell);
}

// Before the light itself the fade narrows, lest what holds a panel dims it.
float fadeWidth(March march, ShadowCone cone) { return min(march.width * march.t, 0.5 * (cone.lightAt - march.t)); }

// On by a ball that nothing reaches into, and by half a grain more: whatever the ray could enter there is deeper. Near
// something that comes nearer steadily, as a wall does, at once to within it; rays to one light fall towards a wall at
// one rate, so the next one jumps from its first reading on. Where nothing was met and the ball there does not reach
// back, something may lie between: from what is sure on again.
void stepOrJump(inout March march, ShadowCone cone, ShadowReading reading) {
  float ball = reading.distanceWorld;
  if (march.t - march.pace * ball > march.sure) {
    march.t = march.sure;
    march.fall = 0.0;
    return;
  }
  float near = NEAR_GRAINS * reading.grain;
  if (march.ball < near) march.fall = (march.ball - ball) * march.pace / max(march.t - march.above, 1e-6);
  float on = ball + LEAST_STEP_GRAINS * reading.grain, way = on;
  if (ball < near && march.fall > LEAST_FALL) way = max((ball + WITHIN_GRAINS * reading.grain) / march.fall, on);
  march.ball = ball;
  march.above = march.t;
  march.sure = march.t + march.pace * on;
  march.t = min(march.t + march.pace * way, cone.end);
}

// A ray is blocked at the surface; just outside it is free to LEAD / (1 + LEAD), for were it darker, all edges would move
// outwards and gaps narrower than the fade go dark; few rays then show steps, which the sharing of pixels hides where
// penumbrae are wide, and a small fade where they are narrow. The fade would go on inside, but sheets reach no depth: let
// it begin there, and thin closed things leak (a saucer). Where nothing is nearer than the plane that the ray leaves, nothing
// dims it.
void stepRay(inout March march, ShadowCone cone, ShadowReading reading, int cell) {
  float past = reading.distanceWorld - BLOCKED_GRAINS * reading.grain, width = fadeWidth(march, cone), lead = LEAD * width;
  float own = overPlane(march, cone);
  bool isOwn = own > 0.0 && past >= own - 2.0 * BLOCKED_GRAINS * reading.grain;
  if (!isOwn) march.free = min(march.free, (past + lead) / (max(width, LEAST_WIDTH_GRAINS * reading.grain) + lead));
  if (past <= 0.0 && !isOwn) {
    endRay(march, cone, 0.0, cell);
    return;
  }
  stepOrJump(march, cone, reading);
  // Out of reads it creeps along a surface, which it would have met if it were not free.
  if (march.sure >= cone.end || march.reads >= MOST_RAY_READS) endRay(march, cone, march.free, cell);
}
