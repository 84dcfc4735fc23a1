// What all passes of a frame know: the view, the picture, the light. One uniform buffer.
#ifndef BRICKFIELD_FRAME_PARAMS_H
#define BRICKFIELD_FRAME_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

struct FrameParams {
  mat4 clipFromEye; // eye space: the world's axes around the eye, so that far from the origin no digits are lost
  mat4 worldFromView;
  vec4 eyeWorld;      // w: near distance, metres
  vec4 projection;    // x, y: clipFromView[0][0], [1][1]; z: 1 orthographic; w: exposure factor
  uvec4 size;         // x, y: pixels; z: lights; w: debug view (DEBUG_VIEW_*)
  uvec4 counts;       // x: SDF instances; y: forced SDF level + 1, or 0; z: trace steps allowed; w: environment mips
  vec4 debugRange;    // x, y: values shown as 0 and 1 by the debug views; z: 1 checks the depth promise
  vec4 eyeAnchored;   // xyz: the eye, metres from the world field's anchor; 0 where no field was asked for
  vec4 irradiance[9]; // spherical harmonics, rgb
  mat4 previousClipFromEye; // clip space of the frame before, without jitter, from eye space of now
  vec4 jitter;              // xy: NDC by which this frame's projection is moved
};
SHARED_ASSERT_SIZE(FrameParams, 128 + 6 * 16 + 9 * 16 + 80)

// A light that is on. Units as in KHR_lights_punctual.
struct LightRow {
  vec4 position;  // world; w: kind (LIGHT_*)
  vec4 direction; // world, where it travels, unit; w: range in metres, 0 infinite
  vec4 intensity; // rgb lux or candela; w: radius in metres, of a sun's disk at one metre
  vec4 cone; // of a spot x: scale, y: offset of its angular falloff; of a rectangle xyz: half its width, w: half its
             // height
};
SHARED_ASSERT_SIZE(LightRow, 64)

SHARED_CONST uint LIGHT_SUN = 0;
SHARED_CONST uint LIGHT_POINT = 1;
SHARED_CONST uint LIGHT_SPOT = 2;
SHARED_CONST uint LIGHT_SPHERE = 3;
SHARED_CONST uint LIGHT_RECTANGLE = 4; // its radius reaches its corners

SHARED_CONST int MOST_SHADOWED_LIGHTS = 4; // the first ones; channels of the shadow texture

SHARED_CONST uint KIND_NONE = 0;
SHARED_CONST uint KIND_MESH = 1;
SHARED_CONST uint KIND_SDF = 2;

SHARED_CONST uint DEBUG_VIEW_NONE = 0;
SHARED_CONST uint DEBUG_VIEW_DEPTH = 1;
SHARED_CONST uint DEBUG_VIEW_NORMAL = 2;
SHARED_CONST uint DEBUG_VIEW_ALBEDO = 3;
SHARED_CONST uint DEBUG_VIEW_ID = 4;
SHARED_CONST uint DEBUG_VIEW_KIND = 5;
SHARED_CONST uint DEBUG_VIEW_STEPS = 6;
SHARED_CONST uint DEBUG_VIEW_BRICKS = 7;
SHARED_CONST uint DEBUG_VIEW_OVERDRAW = 8;
SHARED_CONST uint DEBUG_VIEW_FIELD = 9; // this one and the three behind it read the world field
SHARED_CONST uint DEBUG_VIEW_FIELD_ID = 10;
SHARED_CONST uint DEBUG_VIEW_FIELD_TILES = 11;
SHARED_CONST uint DEBUG_VIEW_FIELD_SURFACE = 12;
SHARED_CONST uint DEBUG_VIEW_SHADOW = 13;
SHARED_CONST uint DEBUG_VIEW_SHADOW_READS = 14;
SHARED_CONST uint DEBUG_VIEW_SHADOW_MAP = 20; // these two read the shadow maps
SHARED_CONST uint DEBUG_VIEW_SHADOW_CASCADE = 21;
SHARED_CONST uint DEBUG_VIEW_MOTION = 22; // these two read what temporal antialiasing keeps
SHARED_CONST uint DEBUG_VIEW_TAA_FRAMES = 23;
SHARED_CONST uint DEBUG_VIEW_AO = 32;
SHARED_CONST uint DEBUG_VIEW_THICKNESS = 33;
SHARED_CONST uint DEBUG_VIEW_REFLECTION = 34;

SHARED_END

#endif
