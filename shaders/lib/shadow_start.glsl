// The stages before the cone of a march for soft shadows: whether the point lies on a sheet or on a solid, what lies between
// it and the cone's beginning, and the way out of sheets that it stands beside.
#include "lib/shadow_march.glsl"

// A surface that is read as 0 is not thickened: higher than this, light passes over what is lower than a grain, which is
// all that shades rough surfaces where the light grazes them.
const float SOLID_LIFT_GRAINS = 0.1;
// Sheets are half a grain thick to each side and read deeper, solids by less: in creases, which interpolation fills. Where
// both may be, and where the cone's first reading, so far from the point, is nearer than most of the height there, as it
// is where a sheet's middle lies between texels, a reading below the surface tells: solids are deep there.
const float SHEET_GRAINS = 0.2, DOUBT_GRAINS = 0.1, FIRST_GRAINS = 0.5, LEAST_LIFTED = 0.8, BELOW_GRAINS = 0.75;
// By as much a point on a sheet is read too near, on average.
const float SHEET_ERROR_GRAINS = 0.3;
// Down from where the cone begins, in parts of the lift; and what is no more than this over the surface is the surface.
const float LEAST_DOWN = 0.1, OWN_SURFACE_GRAINS = 2.0;
const uint MOST_DOWN_READS = 10u;
// Out of what the point stands beside; from half a grain nearer to the eye too, but no more: where the back of a sheet is
// not drawn, that may lead through it.
const float OUT_STEP_GRAINS = 0.2, LEAST_RISE_GRAINS = 0.02, ASIDE_GRAINS = 0.5;
const uint MOST_OUT_READS = 8u;

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

// The cone begins where the way is out, and as high.
void leaveSheet(inout March march, inout ShadowCone cone) {
  march.stage = CONE;
  march.reads = 1u;
  march.sure = march.above = march.t;
  march.lift = cone.lift = march.lift + climbed(march, cone);
}

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

void stepDown(inout March march, ShadowCone cone, ShadowReading reading) {
  march.above -= max(reading.distanceWorld, LEAST_DOWN * cone.lift);
  if (reading.distanceWorld < 0.0)
    finish(march, 0.0);
  else if (march.reads >= MOST_DOWN_READS || march.above < OWN_SURFACE_GRAINS * march.ballGrain)
    leaveSurface(march, cone);
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
