// One sweep over the coarse texels of a tile; run for x, y and z.
#include "lib/field_grid.glsl"
#include "lib/field_sweep.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = kFieldListBinding) readonly buffer ListBlock { uint listed[]; };
layout(std430, binding = kFieldSeedBinding) readonly buffer SeedBlock { uint seeds[]; };
// A texel's own bits change while neighbours read the bits of the sweep before, which stay the same.
layout(std430, binding = kFieldSweepBinding) buffer SweepBlock { uint sweeps[]; };

uniform uint listLength;
uniform int axis;

void main() {
  uint index = listIndex();
  if (index >= listLength) return;
  ListedTile tile = listedTile(listed[index]);
  FieldCascade cascade = field.cascades[tile.cascade];
  ivec3 coarse = tile.firstTexel / COARSE + cubeIndex(int(gl_LocalInvocationIndex), COARSE_TILE);
  ivec3 along = ivec3(axis == 0, axis == 1, axis == 2);
  int reach = int(cascade.texel.z) / 2 + 2; // field/field_windows.h fieldSweepReach
  int best = 1 << 20, bestOffset = 0;
  uint bestWord = 0u;
  for (int step = 0; step <= reach && step * step < best; ++step)
    for (int side = step == 0 ? 1 : -1; side <= 1; side += 2) {
      ivec3 other = coarse + along * (side * step);
      if (!isInWindow(cascade, other * COARSE)) continue;
      uint word = coarseWord(cascade, other);
      uint found = axis == 0 ? 0u : sweeps[word];
      int before = axis == 0 ? (seeds[word] != FIELD_NONE ? 0 : 1 << 20) : sweepCost(found, axis);
      if (before >= 1 << 20 || before + step * step >= best) continue;
      best = before + step * step;
      bestOffset = side * step;
      bestWord = found;
    }
  uint word = coarseWord(cascade, coarse);
  uint own = axis == 0 ? 0u : sweeps[word];
  if (best < 1 << 20)
    own = sweepResult(own, bestWord, bestOffset, axis);
  else // nothing of this or a later sweep
    own &= axis == 1 ? SWEEP_MASK : axis == 2 ? ~(SWEEP_MASK << SWEEP_Z_SHIFT) : 0u;
  sweeps[word] = own;
}
