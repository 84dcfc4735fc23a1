// What a node looks like from far away, where nothing finer is known: its mesh's material, averaged.
#ifndef BRICKFIELD_NODE_LOOK_PARAMS_H
#define BRICKFIELD_NODE_LOOK_PARAMS_H
#include "shared/bridge.h"

SHARED_BEGIN

struct NodeLook {
  vec4 baseColor; // rgb; w: metallic
  vec4 emission;  // rgb; w: roughness
};
SHARED_ASSERT_SIZE(NodeLook, 32)

SHARED_END

#endif
