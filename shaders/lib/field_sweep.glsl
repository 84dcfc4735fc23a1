// Offsets to the nearest seed, as three sweeps along the axes find them (a distance transform in the way of
// Felzenszwalb and Huttenlocher 2012, but by plain search in a window: it is short). One word holds what the three
// leave, seven bits each: x: offset along x; y: offsets along x and y to the best in the plane; z: offset along z.
// 0: no seed within reach.
#include "lib/field_grid.glsl"

const int SWEEP_BIAS = 64;
const uint SWEEP_MASK = 127u;
const uint SWEEP_ROW_SHIFT = 0u, SWEEP_PLANE_X_SHIFT = 7u, SWEEP_PLANE_Y_SHIFT = 14u, SWEEP_Z_SHIFT = 21u;

uint sweepBits(int offset, uint shift) { return uint(offset + SWEEP_BIAS) << shift; }
int sweepOffset(uint word, uint shift) { return int(word >> shift & SWEEP_MASK) - SWEEP_BIAS; }
bool hasSweep(uint word, uint shift) { return (word >> shift & SWEEP_MASK) != 0u; }

// Squared distance to what the sweeps before `axis` found, or a large number.
int sweepCost(uint word, int axis) {
  if (axis == 1) {
    int x = sweepOffset(word, SWEEP_ROW_SHIFT);
    return hasSweep(word, SWEEP_ROW_SHIFT) ? x * x : 1 << 20;
  }
  int x = sweepOffset(word, SWEEP_PLANE_X_SHIFT), y = sweepOffset(word, SWEEP_PLANE_Y_SHIFT);
  return hasSweep(word, SWEEP_PLANE_X_SHIFT) ? x * x + y * y : 1 << 20;
}

// The word after the sweep along `axis` found its best at `offset`, whose word is `found`.
uint sweepResult(uint own, uint found, int offset, int axis) {
  if (axis == 0) return sweepBits(offset, SWEEP_ROW_SHIFT);
  if (axis == 1)
    return (own & SWEEP_MASK) | sweepBits(sweepOffset(found, SWEEP_ROW_SHIFT), SWEEP_PLANE_X_SHIFT) |
           sweepBits(offset, SWEEP_PLANE_Y_SHIFT);
  return (own & ~(SWEEP_MASK << SWEEP_Z_SHIFT)) | sweepBits(offset, SWEEP_Z_SHIFT);
}

// Coarse texels that a sweep looks to either side; field/field_windows.h fieldSweepReach.
int sweepReach(FieldCascade cascade) { return max(int(cascade.texel.z) / 2 + 2, 8); }
