// One ray against one object's bricks: empty cells are crossed by their bound, bricks sphere-traced, and near the
// surface the crossing is solved voxel by voxel. Hart 1996 for the stepping; in a voxel the trilinear field along a ray
// is a cubic, whose first root is bracketed between the cubic's extrema (Marmitt et al. 2004).
//
// The direction is not normalized: t is the caller's (metres of world), whatever affine transform led to grid space.
#include "lib/bricks.glsl"

struct TraceHit {
  bool hit;
  bool backFace;    // the surface was left, not entered
  float t;
  uint steps;       // iterations: cells, distance reads and voxels
  uint brickReads;  // of them, those that read distances
};

// Central differences over two voxels: wide enough to smooth the 8-bit quantum, narrow enough to keep edges.
const float kNormalRadiusVoxels = 1.0;
// A trilinear field of 1-Lipschitz samples can change by √3 per voxel, so I/√3 never steps through; nor does I - √3,
// as far as the voxel's farthest corner could lie (the design's safe step).
const float kSqrt3 = 1.7320508;
const float kOneOverSqrt3 = 0.57735027;
// Below this many voxels a step by distance gains less than solving the voxel outright.
const float kSolveVoxels = 0.6;
// Nudge over a border, in level voxels; a crossing in the gap shows as a sign that differs at the next voxel's entry.
const float kNudgeVoxels = 1e-4;

// Coefficients c0 + c1 u + c2 u² + c3 u³ of the trilinear field along a + u b.
vec4 cubicAlongRay(vec4 lower, vec4 upper, vec3 a, vec3 b) {
  float k0 = lower.x, k1 = lower.y - lower.x, k2 = lower.z - lower.x, k3 = upper.x - lower.x;
  float k4 = lower.w - lower.z - k1, k5 = upper.z - upper.x - k2, k6 = upper.y - upper.x - k1;
  float k7 = upper.w - upper.z - upper.y + upper.x - k4;
  float c0 = k0 + a.x * k1 + a.y * k2 + a.z * k3 + a.x * a.y * k4 + a.y * a.z * k5 + a.x * a.z * k6 + a.x * a.y * a.z * k7;
  float c1 = b.x * k1 + b.y * k2 + b.z * k3 + (a.x * b.y + b.x * a.y) * k4 + (a.y * b.z + b.y * a.z) * k5 +
             (a.x * b.z + b.x * a.z) * k6 + (b.x * a.y * a.z + a.x * b.y * a.z + a.x * a.y * b.z) * k7;
  float c2 = b.x * b.y * k4 + b.y * b.z * k5 + b.x * b.z * k6 +
             (a.x * b.y * b.z + b.x * a.y * b.z + b.x * b.y * a.z) * k7;
  return vec4(c0, c1, c2, b.x * b.y * b.z * k7);
}

float cubicAt(vec4 c, float u) { return ((c.w * u + c.z) * u + c.y) * u + c.x; }

// First u in [0, end] at which the cubic turns from the sign s of the state to the other; negative if none.
float firstCrossing(vec4 c, float end, float s) {
  if (cubicAt(c, 0.0) * s < 0.0) return 0.0;
  // Extrema split [0, end] into monotonic stretches.
  float discriminant = c.z * c.z - 3.0 * c.w * c.y;
  vec2 extrema = vec2(end);
  if (discriminant > 0.0) {
    // The stable form of the roots of 3 c3 u² + 2 c2 u + c1; a vanishing c3 leaves the linear root.
    float q = -(c.z + (c.z >= 0.0 ? 1.0 : -1.0) * sqrt(discriminant));
    float u0 = abs(c.w) > 1e-12 ? q / (3.0 * c.w) : end;
    float u1 = abs(q) > 1e-12 ? c.y / q : end;
    extrema = clamp(vec2(min(u0, u1), max(u0, u1)), 0.0, end);
  }
  float low = 0.0;
  for (int stretch = 0; stretch < 3; ++stretch) {
    float high = stretch == 0 ? extrema.x : stretch == 1 ? extrema.y : end;
    if (cubicAt(c, high) * s < 0.0) {
      float fLow = cubicAt(c, low), fHigh = cubicAt(c, high);
      // Illinois: regula falsi that halves the value of an end kept twice, and so cannot stall; six rounds reach float
      // precision on a monotonic cubic.
      float middle = high, kept = 0.0;
      for (int round = 0; round < 6; ++round) {
        middle = clamp(low + (high - low) * fLow / (fLow - fHigh), low, high);
        float f = cubicAt(c, middle);
        if (f * s < 0.0) {
          high = middle, fHigh = f;
          if (kept < 0.0) fLow *= 0.5;
          kept = -1.0;
        } else {
          low = middle, fLow = f;
          if (kept > 0.0) fHigh *= 0.5;
          kept = 1.0;
        }
      }
      return middle; // the last estimate: the bracket's far end may not have moved
    }
    low = high;
  }
  return -1.0;
}

// The voxel in which the ray is at t. Where rounding puts the point on the near side of a border that the ray has
// crossed by then, the voxel beyond counts: a ray almost parallel to the border would else meet it again and again.
vec3 voxelAt(vec3 origin, vec3 oneOverDirection, vec3 pointLevel, float t, vec3 lastVoxel) {
  vec3 voxel = floor(pointLevel);
  vec3 forwards = step(vec3(0.0), oneOverDirection);
  vec3 exits = (voxel + forwards - origin) * oneOverDirection;
  voxel += vec3(lessThanEqual(exits, vec3(t))) * (2.0 * forwards - 1.0);
  return clamp(voxel, vec3(0.0), lastVoxel);
}

// t at which the ray leaves the axis-aligned cell [lower, upper] (its own space); the direction has no zero component.
float cellExit(vec3 origin, vec3 oneOverDirection, vec3 lower, vec3 upper) {
  vec3 far = max((lower - origin) * oneOverDirection, (upper - origin) * oneOverDirection);
  return min(far.x, min(far.y, far.z));
}

// Traces t in [tBegin, tEnd]. A ray that begins inside the solid first leaves it; that exit is a hit only where
// doubleSided is set.
TraceHit traceBricks(SdfLevel level, vec3 originGrid, vec3 directionGrid, vec2 tRange, bool doubleSided, uint maxSteps) {
  vec3 origin = originGrid * level.scale.x;
  vec3 direction = directionGrid * level.scale.x;
  float speed = length(direction); // level voxels per unit of t
  // Zero components become tiny: exits along them lie at infinity, not at NaN.
  vec3 safe = mix(direction, vec3(speed * 1e-12), lessThan(abs(direction), vec3(speed * 1e-12)));
  vec3 oneOverDirection = 1.0 / safe;
  vec3 bricksUpper = vec3(level.cells.yzw) * float(BRICK_CELLS);
  float nudge = kNudgeVoxels / speed;

  TraceHit result = TraceHit(false, false, tRange.y, 0u, 0u);
  float t = tRange.x;
  float state = 0.0; // sign of the field where the ray is; 0: not known yet
  while (t <= tRange.y && result.steps < maxSteps) {
    ++result.steps;
    vec3 p = clamp(origin + t * direction, vec3(0.0), bricksUpper);
    vec3 voxelLevel = voxelAt(origin, oneOverDirection, p, t, bricksUpper - 1.0);
    ivec3 brick = ivec3(voxelLevel) / int(BRICK_CELLS);
    vec3 brickLower = vec3(brick) * float(BRICK_CELLS);
    uint cell = cellOfBrick(level.cells.x, level, brick);
    if ((cell & CELL_EMPTY) != 0u) {
      float bound = boundOfCell(cell);
      state = (cell & CELL_INSIDE) != 0u ? -1.0 : 1.0;
      float exitT = cellExit(origin, oneOverDirection, brickLower, brickLower + float(BRICK_CELLS));
      t = max(max(exitT, t) + nudge, t + abs(bound) / speed);
      continue;
    }
    ++result.brickReads;
    vec3 pointBrick = clamp(p - brickLower, vec3(0.0), vec3(BRICK_CELLS));
    float d = brickDistance(level, cell, pointBrick);
    if (state == 0.0 && abs(d) > kSolveVoxels) state = sign(d);
    if (d * state > kSolveVoxels) {
      t += max(abs(d) * kOneOverSqrt3, abs(d) - kSqrt3) / speed;
      continue;
    }
    vec3 voxel = voxelLevel - brickLower;
    vec4 lower, upper;
    voxelCorners(level, cell, ivec3(voxel), lower, upper);
    float exitT = max(cellExit(origin, oneOverDirection, brickLower + voxel, brickLower + voxel + 1.0), t);
    vec4 cubic = cubicAlongRay(lower, upper, clamp(pointBrick - voxel, 0.0, 1.0), direction);
    if (state == 0.0) state = cubic.x < 0.0 ? -1.0 : 1.0;
    // Solved to the voxel's end, not the range's: a hit must not depend on where a mesh ends the ray, to the last bit.
    float u = firstCrossing(cubic, exitT - t, state);
    if (u >= 0.0) {
      bool entered = state > 0.0;
      if (t + u > tRange.y) return result;
      if (entered || doubleSided) {
        result.hit = true;
        result.backFace = !entered;
        result.t = t + u;
        return result;
      }
      state = 0.0; // asked again beyond the border, where rounding cannot turn it back
      t += u + nudge;
      continue;
    }
    t = exitT + nudge;
  }
  return result;
}
