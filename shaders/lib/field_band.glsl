// The band: tiles with a texel within four texels of a surface. There values are made with more care.
#include "shared/world_field_params.h"

// Four texels, from a texel's centre to the next coarse one's (0.87), half a sheet, and what the coarse candidate may
// err by.
const float BAND_TEXELS = 6.5;
// Rank, half a texel more than the distance from closed surfaces, up to which texels of the band are evaluated
// themselves. What is found for those that prove to lie a little farther is kept as well: between coarse values the
// field might be larger than the truth there.
const float FINE_TEXELS = 5.0, KEPT_TEXELS = 6.0;
bool isBandTile(FieldTile tile) { return uintBitsToFloat(tile.nearestBits) < BAND_TEXELS; }

// Any of its coarse texels found a surface within reach.
bool isReachedTile(FieldTile tile) { return tile.nearest != FIELD_NONE; }
