// Shadow maps of the first lights: one array of square maps, a layer a cascade, a spot or a face of a cube.
#ifndef BRICKFIELD_SHADOW_MAP_PARAMS_H
#define BRICKFIELD_SHADOW_MAP_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

SHARED_CONST uint MOST_SHADOW_LAYERS = 24; // six for each of the shadowed lights

struct ShadowMapLayer {
  mat4 clipFromEye; // of the layer's own eye
  mat4 eyeFromClip;
  vec4 eyeWorld; // w: metres a texel; of perspective layers at one metre along the view
  vec4 depth;    // x: near, y: far distance, metres; z: 1 parallel; w: 1 where all of the scene lies in it
};
SHARED_ASSERT_SIZE(ShadowMapLayer, 160)

struct ShadowMapLight {
  ivec4 layers; // x: first; y: count, 0: without shadows; z: SHADOW_LAYOUT_*
};
SHARED_ASSERT_SIZE(ShadowMapLight, 16)

struct ShadowMapParams {
  ShadowMapLayer layers[MOST_SHADOW_LAYERS];
  ShadowMapLight lights[4];
  ivec4 size; // x: texels of a side; y: layers; z: levels of their ranges
};
SHARED_ASSERT_SIZE(ShadowMapParams, 160 * 24 + 5 * 16)

SHARED_CONST int SHADOW_LAYOUT_CASCADES = 0;
SHARED_CONST int SHADOW_LAYOUT_SPOT = 1;
SHARED_CONST int SHADOW_LAYOUT_CUBE = 2;

SHARED_CONST int SHADOW_FILTER_PCF = 0;
SHARED_CONST int SHADOW_FILTER_EVSM = 1;

SHARED_CONST int SHADOW_BLUR_RADIUS = 7; // of EVSM: 15 texels a side, as the RTSDF paper's

SHARED_END

#endif
