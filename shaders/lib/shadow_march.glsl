// The state of a march for soft shadows, and what all of its stages know of the way: how high over the surface it runs, how
// far it may go on.
#include "lib/frame.glsl"
#include "lib/shadow_cone.glsl"

// Steps of 0.6 pass through some of the slabs that bricks hold for sheets.
const float LIFT_GRAINS = 1.0, LEAST_STEP_GRAINS = 0.5;
// The lift fades by this part of what the light climbs over the surface, so that the way never sinks back into it, but
// within so many grains.
const float LIFT_FADE = 0.67, MOST_LIFT_FADE_GRAINS = 16.0;
// A sheet midway between texels is interpolated to nothing deeper than 0: what is as near as this is in the way.
const float BLOCKED_GRAINS = 0.01;
// More of the lift stays than that, lest rays that hardly climb end at the surface.
const float LEAST_LIFT_GRAINS = 0.02;
// What hard edges fade over.
const float LEAST_WIDTH_GRAINS = 0.1;
// Up to so far away as much is read too near as at the point.
const float ERROR_FADE_GRAINS = 1.0;
// Of what a ball permits.
const float RELAXED = 1.8;

struct ShadowReading {
  float distanceWorld;
  float grain;
  float coarsestGrain; // of all around the point: the field's, where one of them has no bricks
};

// One march of many stages with one place where it reads: threads in different stages read together, and the program
// stays small.
//
//   GRAIN  how fine the distances at the point are
//   BELOW  where they may be a sheet's: whether they are a solid's
//   CONE   to the light, until something reaches into it
//   DOWN   where what the cone's first reading was of is finer than the lift: whether that lies between the surface and
//          the cone's beginning, as a saucer does over the floor
//   OUT    where the point at a wall's foot lies within the half texel that the field adds to sheets: whether the way
//          leads out of it from the first small step on. From the wall's far side it would cross the sheet first
//   ASIDE  where it does not: the same from nearer to the eye, for in its middle a sheet is too flat to tell
//   RAY    one after the other
const uint GRAIN = 0u, BELOW = 1u, DOWN = 2u, OUT = 3u, ASIDE = 4u, CONE = 5u, RAY = 6u, DONE = 7u;

struct March {
  uint stage;
  uint reads;  // of the stage
  float t;     // metres along the axis
  float lift;  // metres, before it fades
  float error; // metres; of what is read at the point
  float share; // what is seen of the light, once it is DONE
  // CONE, RAY
  float sure; // metres; free up to there
  float relaxed;
  // Where and what the reading before was; DOWN, OUT, ASIDE: see there
  float above; // the surface, metres
  float ball;  // metres, and its grain: the cone's first reading, or the one before
  float ballGrain;
  // RAY
  int ray;
  int rays;
  float start;  // of them all, metres along the axis
  float width;  // of their fade, a metre
  vec3 across;  // to which part of the light, metres a metre along the axis
  float pace;
  float free;   // how free the ray is where it is touched most
  float sum;
  float fall;   // of the distance to what is ahead, metres a metre of the ray; 0: not known
};

// How far the cone goes on, and back (y), inside a ball around its axis that nothing reaches into.
vec2 wayInBall(float ball, float radius, float spread) {
  float along = radius * spread, a = 1.0 + spread * spread;
  float reach = sqrt(max(along * along + a * (ball * ball - radius * radius), 0.0));
  return vec2(reach - along, reach + along) / a;
}

// What the way climbs over the surface makes up for the lift, metres.
float climbed(March march, ShadowCone cone) {
  return march.t * max(LIFT_FADE * dot(cone.normal, cone.axis), LIFT_GRAINS / MOST_LIFT_FADE_GRAINS);
}

// What is left of the lift, metres.
float liftLeft(March march, ShadowCone cone) {
  return max(march.lift - climbed(march, cone), LEAST_LIFT_GRAINS * cone.grain);
}

// Where the march reads next, metres over the plane of the surface.
float overPlane(March march, ShadowCone cone) {
  return liftLeft(march, cone) + march.t * dot(cone.normal, cone.axis + march.across);
}

void finish(inout March march, float share) {
  march.stage = DONE;
  march.share = share;
}

void begin(inout March march, uint stage, float t) {
  march.stage = stage;
  march.t = t;
  march.reads = 0u;
}

// On by a ball of the cone that nothing reaches into, and farther (Keinert and others 2014).
void goOn(inout March march, ShadowCone cone, float way, float grain) {
  float on = max(way, LEAST_STEP_GRAINS * grain);
  march.sure = march.t + on;
  march.t = min(march.t + march.relaxed * on, cone.end);
  march.relaxed = RELAXED;
  if (march.sure >= cone.end) finish(march, 1.0);
}

// Of what is read, so far on the way.
float errorAt(March march, ShadowCone cone, float t) {
  return march.error * max(1.0 - t / (ERROR_FADE_GRAINS * cone.grain), 0.0);
}
