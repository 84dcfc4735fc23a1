// Soft shadows from the world field, and from bricks where it is too coarse. One cone from the point to the whole light
// goes first: most points see all of the light or none of it, a read a step. Where something first reaches into the
// cone, narrow rays go on from there to parts of the light, a share of it each.
//
//        light            p: point, lifted off its surface by up to a grain, which fades out as the light climbs
//      \  ---  /          t: first touched; from there on the rays
//       \ | | /
//        \|||/ ___ caster
//         \|/ t
//          p
// A grain is what nothing in a reading is finer than: a texel of the field, a voxel of bricks.
#include "lib/frame.glsl"
#include "lib/shadow_cone.glsl"

// By whoever includes this, before:
//   const bool ENDS_DARK            whether half of the rays may say that the others are blocked too
//   const float SHEET_MOST_GRAINS   what is read as deep below the surface is of a solid, not of a sheet
//   const float LIFT_TOWARDS_EYE    so much of the lift leads to the eye besides. Nothing lies between: where a point
//                                   stands beside a sheet, that leads out of it, on the side that is seen

const uint MOST_CONE_READS = 96u, MOST_RAY_READS = 64u;
// Steps of 0.6 pass through some of the slabs that bricks hold for sheets.
const float LIFT_GRAINS = 1.0, LEAST_STEP_GRAINS = 0.5;
// A surface that is read as 0 is not thickened: higher than this, light passes over what is lower than a grain, which is
// all that shades rough surfaces where the light grazes them.
const float SOLID_LIFT_GRAINS = 0.1;
// Sheets are half a grain thick to each side and read deeper, solids by less: in creases, which interpolation fills. Where
// both may be, and where the cone's first reading, so far from the point, is nearer than most of the height there, as it
// is where a sheet's middle lies between texels, a reading below the surface tells: solids are deep there.
const float SHEET_GRAINS = 0.2, DOUBT_GRAINS = 0.1, FIRST_GRAINS = 0.5, LEAST_LIFTED = 0.8, BELOW_GRAINS = 0.75;
// By as much the point itself is read too near, and what lies around it, up to a grain away; of sheets on average.
const float SHEET_ERROR_GRAINS = 0.3, ERROR_FADE_GRAINS = 1.0;
// The lift fades by this part of what the light climbs over the surface, so that the way never sinks back into it, but
// within so many grains.
const float LIFT_FADE = 0.67, MOST_LIFT_FADE_GRAINS = 16.0;
// More of it stays than BLOCKED_GRAINS, lest rays that hardly climb end at the surface.
const float LEAST_LIFT_GRAINS = 0.02;
// What hard edges fade over.
const float LEAST_WIDTH_GRAINS = 0.1;
// A sheet midway between texels is interpolated to nothing deeper than 0: what is as near as this is in the way.
const float BLOCKED_GRAINS = 0.01;
// Of what a ball permits.
const float RELAXED = 1.8;
// Of a penumbra's radius for each ray: where steps are narrower than this none are seen, and sharing would only blur.
const float SHARED_PIXELS = 1.0;
const int LEAST_SURE_RAYS = 3;
// Slower than this falls what is passed; and so far behind the front of a wall lies a sheet's middle.
const float NEAR_GRAINS = 2.5, LEAST_FALL = 0.25, WITHIN_GRAINS = 0.5;
const float FADE = 0.5; // of the distance between rays, about
const float LEAD = 8.0; // see stepRay
// Down from where the cone begins, in parts of the lift; and what is no more than this over the surface is the surface.
const float LEAST_DOWN = 0.1, OWN_SURFACE_GRAINS = 2.0;
const uint MOST_DOWN_READS = 10u;
// Out of what the point stands beside; from half a grain nearer to the eye too, but no more: where the back of a sheet is
// not drawn, that may lead through it.
const float OUT_STEP_GRAINS = 0.2, LEAST_RISE_GRAINS = 0.02, ASIDE_GRAINS = 0.5;
const uint MOST_OUT_READS = 8u;
// Where the way leaves a sheet nearly along it: outside by so much at least, and so many metres more in each of the way.
const float LEAVING_GRAINS = 0.02, LEAST_LEAVING = 0.02;

uint shadowReads = 0u; // of this thread
bool isMeanOfCell = false; // what was marched last, see partOfLight

struct ShadowReading {
  float distanceWorld;
  float grain;
  float coarsestGrain; // of all around the point: the field's, where one of them has no bricks
};
// By whoever includes this: from the field alone, or with bricks.
//
// keepsObjects  only of those with bricks that the last reading was of, within mostMetres; much, where there are none
ShadowReading readForShadow(vec3 pointAnchored, float mostMetres, bool keepsObjects);

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
  // DOWN, OUT, ASIDE; RAY: where and what the reading before was
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

// Where the cone first reads: nearer to the point it could tell no more than what was read there.
float firstStep(ShadowCone cone) { return min(FIRST_GRAINS * cone.grain, 0.5 * cone.end); }

void beginCone(inout March march, inout ShadowCone cone, float lift) {
  march.lift = cone.lift = lift;
  begin(march, CONE, firstStep(cone));
}

void beginOnSolid(inout March march, inout ShadowCone cone) { beginCone(march, cone, SOLID_LIFT_GRAINS * cone.grain); }

void beginOnSheet(inout March march, inout ShadowCone cone) {
  march.error = -SHEET_ERROR_GRAINS * cone.grain;
  beginCone(march, cone, LIFT_GRAINS * cone.grain);
}

bool isOnSheet(ShadowCone cone) { return cone.lift >= LIFT_GRAINS * cone.grain; }

void stepGrain(inout March march, inout ShadowCone cone, ShadowReading reading) {
  cone.grain = reading.coarsestGrain;
  if (cone.isRectangle) cone.end = min(cone.end, max(cone.lightAt - reading.grain, 0.0)); // there it begins
  march.error = min(reading.distanceWorld, 0.0);
  if (reading.grain < cone.grain || march.error < -SHEET_GRAINS * cone.grain)
    beginOnSheet(march, cone);
  else if (march.error < -DOUBT_GRAINS * cone.grain)
    begin(march, BELOW, 0.0);
  else
    beginOnSolid(march, cone);
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

// The cone's first step, once nothing is known to lie below where it begins. Beside a solid too: what stands there, lower
// than a grain, is what the rays find.
void leaveSurface(inout March march, ShadowCone cone) {
  march.stage = CONE;
  march.reads = 1u;
  march.t = march.above = firstStep(cone);
  if (isOnSheet(cone) && march.ball < LEAST_WIDTH_GRAINS * march.ballGrain)
    begin(march, OUT, 0.0);
  else
    goOn(march, cone, wayInBall(march.ball, cone.spread * march.t, cone.spread).x, march.ballGrain);
}

void stepFirst(inout March march, ShadowCone cone, ShadowReading reading) {
  march.ball = reading.distanceWorld;
  march.ballGrain = reading.grain;
  march.above = cone.lift;
  if (!isOnSheet(cone) && march.ball < LEAST_LIFTED * overPlane(march, cone))
    march.stage = BELOW;
  else if (reading.grain < cone.grain && march.above >= OWN_SURFACE_GRAINS * reading.grain)
    begin(march, DOWN, 0.0);
  else
    leaveSurface(march, cone);
}

void stepBelow(inout March march, inout ShadowCone cone, ShadowReading reading) {
  if (reading.distanceWorld > -SHEET_MOST_GRAINS * cone.grain)
    beginOnSheet(march, cone);
  else if (cone.lift > 0.0)
    leaveSurface(march, cone);
  else
    beginOnSolid(march, cone);
}

// Whether what is near is the sheet that the way leaves, nearly along it: what is read rises, and is outside. Where a sheet
// is crossed neither holds: there it is inside, or falls. Not less the point's error: that fades faster than such ways rise.
bool isLeavingSheet(March march, ShadowCone cone, float ball) {
  float read = ball + errorAt(march, cone, march.t), before = march.ball + errorAt(march, cone, march.above);
  return isOnSheet(cone) && read >= LEAVING_GRAINS * cone.grain && read >= before + LEAST_LEAVING * (march.t - march.above);
}

void stepCone(inout March march, inout ShadowCone cone, ShadowReading reading, float softness, int cell) {
  float radius = cone.spread * march.t, ball = reading.distanceWorld, touch = radius;
  if (march.reads == 1u) {
    stepFirst(march, cone, reading);
    return;
  }
  if (!isLeavingSheet(march, cone, ball)) touch = max(touch, LEAST_WIDTH_GRAINS * reading.grain);
  vec2 way = wayInBall(ball, radius, cone.spread);
  if (march.t > march.sure && (ball < touch || march.t - way.y > march.sure)) { // the ball does not reach back: there again
    march.t = march.sure;
    march.relaxed = 1.0;
  } else if (ball < -touch) {
    finish(march, 0.0);
  } else if (ball < touch) {
    beginRays(march, cone, march.t, softness, cell);
  } else {
    march.ball = ball;
    march.above = march.t;
    goOn(march, cone, way.x, reading.grain);
  }
  if (march.stage == CONE && march.reads >= MOST_CONE_READS) beginRays(march, cone, march.sure, softness, cell);
}

void stepDown(inout March march, ShadowCone cone, ShadowReading reading) {
  march.above -= max(reading.distanceWorld, LEAST_DOWN * cone.lift);
  if (reading.distanceWorld < 0.0)
    finish(march, 0.0);
  else if (march.reads >= MOST_DOWN_READS || march.above < OWN_SURFACE_GRAINS * march.ballGrain)
    leaveSurface(march, cone);
}

// The cone begins where the way is out, and as high.
void leaveSheet(inout March march, inout ShadowCone cone) {
  march.stage = CONE;
  march.reads = 1u;
  march.sure = march.above = march.t;
  march.lift = cone.lift = march.lift + climbed(march, cone);
}

void stepOut(inout March march, inout ShadowCone cone, ShadowReading reading) {
  bool isAside = march.stage == ASIDE, isFirst = march.t == 0.0;
  bool isOut = reading.distanceWorld > LEAST_WIDTH_GRAINS * reading.grain;
  bool isRising = reading.distanceWorld >= march.ball + LEAST_RISE_GRAINS * cone.grain;
  bool isLost = !isFirst && (!isRising || (!isOut && march.reads >= MOST_OUT_READS));
  if (isLost && isAside) {
    finish(march, 0.0);
  } else if (isLost) {
    cone.origin += ASIDE_GRAINS * cone.grain * directionToEye(cone.origin - frame.eyeAnchored.xyz);
    begin(march, ASIDE, 0.0);
  } else if (isOut && !isFirst) {
    leaveSheet(march, cone);
  } else {
    march.ball = reading.distanceWorld;
    march.t += OUT_STEP_GRAINS * cone.grain;
  }
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

// Where the march reads next.
vec3 placeOf(March march, ShadowCone cone) {
  if (march.stage == BELOW) return cone.origin - BELOW_GRAINS * cone.grain * cone.normal;
  float lift = march.stage < CONE ? march.lift : liftLeft(march, cone);
  if (march.stage == DOWN) lift = march.above;
  vec3 off = cone.normal;
  if (LIFT_TOWARDS_EYE > 0.0) off += LIFT_TOWARDS_EYE * directionToEye(cone.origin - frame.eyeAnchored.xyz);
  return cone.origin + lift * off + march.t * (cone.axis + march.across);
}

// Where bricks end, or a cascade, the field begins to make the surface thicker than the lift: what lies in the way there
// is asked once more, a coarser grain higher.
bool isToBeRaised(March march, ShadowCone cone, ShadowReading reading) {
  bool isTouched = reading.distanceWorld < LEAST_WIDTH_GRAINS * reading.grain;
  return march.stage >= OUT && isTouched && march.lift == cone.lift && reading.grain > cone.grain &&
         LIFT_GRAINS * reading.grain > climbed(march, cone);
}

// The visible share of the light, 0 to 1.
//
// rays      at most so many
// softness  of the fade between them: 1 as wide as they are apart, about
// cell      of partOfLight
float shadowOf(ShadowCone cone, int rays, float softness, int cell) {
  isMeanOfCell = false;
  if (dot(cone.normal, cone.axis) < -cone.spread) return 0.0; // behind the surface's horizon
  March march;
  march.across = vec3(0.0);
  march.lift = cone.lift = march.error = 0.0;
  march.sure = 0.0;
  march.relaxed = RELAXED;
  march.rays = rays;
  begin(march, GRAIN, 0.0);
  while (march.stage != DONE) {
    ShadowReading reading = readForShadow(placeOf(march, cone), cone.lift, march.stage == DOWN);
    if (isToBeRaised(march, cone, reading)) {
      march.lift = LIFT_GRAINS * reading.grain;
      continue;
    }
    march.lift = cone.lift;
    if (march.stage >= CONE) reading.distanceWorld -= errorAt(march, cone, march.t);
    ++march.reads;
    if (march.stage == RAY)
      stepRay(march, cone, reading, cell);
    else if (march.stage == CONE)
      stepCone(march, cone, reading, softness, cell);
    else if (march.stage == OUT || march.stage == ASIDE)
      stepOut(march, cone, reading);
    else if (march.stage == BELOW)
      stepBelow(march, cone, reading);
    else if (march.stage == DOWN)
      stepDown(march, cone, reading);
    else
      stepGrain(march, cone, reading);
  }
  return march.share;
}
