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
#include "lib/shadow_rays.glsl"
#include "lib/shadow_start.glsl"

// By whoever includes this, before:
//   const bool ENDS_DARK            whether half of the rays may say that the others are blocked too
//   const float SHEET_MOST_GRAINS   what is read as deep below the surface is of a solid, not of a sheet
//   const float LIFT_TOWARDS_EYE    so much of the lift leads to the eye besides. Nothing lies between: where a point
//                                   stands beside a sheet, that leads out of it, on the side that is seen

const uint MOST_CONE_READS = 96u;
// Where the way leaves a sheet nearly along it: outside by so much at least, and so many metres more in each of the way.
const float LEAVING_GRAINS = 0.02, LEAST_LEAVING = 0.02;

uint shadowReads = 0u; // of this thread

// By whoever includes this: from the field alone, or with bricks.
//
// keepsObjects  only of those with bricks that the last reading was of, within mostMetres; much, where there are none
ShadowReading readForShadow(vec3 pointAnchored, float mostMetres, bool keepsObjects);

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
