// Texels of a tile that a group evaluates together after the others, in whatever order, so that its threads do alike.
// A group has 256 threads; texel k * 256 + thread of the tile is the thread's own, k = 0 and 1.
#include "shared/world_field_params.h"

const uint OPEN_THREADS = 256u;
const int OWN_TEXELS = int(FIELD_TILE_TEXELS / OPEN_THREADS);
shared uint open[FIELD_TILE_TEXELS];
shared uint openCount, lastOpenCount; // one thread zeroes them before a barrier

// mine  bits k: which of the thread's own texels are open. One atomic a thread: those to one address wait for each
//       other.
void listOpen(uint mine) {
  if (mine == 0u) return;
  uint place = atomicAdd(openCount, uint(bitCount(mine)));
  for (int k = 0; k < OWN_TEXELS; ++k)
    if ((mine & 1u << k) != 0u) open[place++] = uint(k) * OPEN_THREADS + gl_LocalInvocationIndex;
}

// The same of those that need other work, from the end of the list, so that threads of a warp do alike.
void listLastOpen(uint mine) {
  if (mine == 0u) return;
  uint place = FIELD_TILE_TEXELS - atomicAdd(lastOpenCount, uint(bitCount(mine)));
  for (int k = 0; k < OWN_TEXELS; ++k)
    if ((mine & 1u << k) != 0u) open[--place] = uint(k) * OPEN_THREADS + gl_LocalInvocationIndex;
}
uint lastOpen(uint number) { return open[FIELD_TILE_TEXELS - 1u - number]; }
