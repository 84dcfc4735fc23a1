// Ambient occlusion from the world field: its forms, and how what is traced at fewer pixels becomes the picture's.
#ifndef BRICKFIELD_FIELD_OCCLUSION_PARAMS_H
#define BRICKFIELD_FIELD_OCCLUSION_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

SHARED_CONST int OCCLUSION_TAPS = 1;  // five along the normal
SHARED_CONST int OCCLUSION_RAYS = 2;  // five along each of a few rays
SHARED_CONST int OCCLUSION_CONES = 3; // narrow cones, traced

// Pixels of the traced picture in a square of this side each have other directions; the square as a whole has all.
SHARED_CONST int OCCLUSION_PATTERN_SIDE = 4;

SHARED_END

#endif
