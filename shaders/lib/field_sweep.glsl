// Offsets to the nearest seed of coarse texels, by a distance transform in a window: in planes across z first, then
// along z. One word holds what both leave: in the low ten bits the offset in the plane, five bits an axis; above them
// its square, or NO_SEED_IN_PLANE; in the high fourteen the offset to the nearest seed of all and one, or 0.
#include "lib/field_grid.glsl"

const int SWEEP_REACH = 10; // the longest, fieldSweepReach(16)
const int SWEEP_SIDE = 2 * SWEEP_REACH + 1;
const uint NO_SEED_IN_PLANE = 255u;
const uint SWEEP_PLANE_BITS = 18u;

uint planeWord(uint cost, ivec2 offset) {
  return cost << 10u | uint(offset.y + SWEEP_REACH) << 5u | uint(offset.x + SWEEP_REACH);
}
uint planeCost(uint word) { return word >> 10u & 255u; }
ivec2 planeOffset(uint word) { return ivec2(word & 31u, word >> 5u & 31u) - SWEEP_REACH; }

uint seedWord(uint word, ivec3 offset) {
  ivec3 at = offset + SWEEP_REACH;
  return (word & (1u << SWEEP_PLANE_BITS) - 1u) |
         uint((at.z * SWEEP_SIDE + at.y) * SWEEP_SIDE + at.x + 1) << SWEEP_PLANE_BITS;
}
bool hasSeed(uint word) { return word >> SWEEP_PLANE_BITS != 0u; }
ivec3 seedOffset(uint word) {
  int at = int(word >> SWEEP_PLANE_BITS) - 1;
  return ivec3(at % SWEEP_SIDE, at / SWEEP_SIDE % SWEEP_SIDE, at / (SWEEP_SIDE * SWEEP_SIDE)) - SWEEP_REACH;
}

// Coarse texels that a sweep looks to either side; field/field_windows.h fieldSweepReach.
int sweepReach(FieldCascade cascade) { return max(int(cascade.texel.z) / 2 + 2, 8); }
