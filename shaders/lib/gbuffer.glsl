// Reads of the G-buffer, the same for every pass after geometry.
#include "lib/frame.glsl"
#include "lib/octahedral.glsl"
#include "lib/packing.glsl"

layout(binding = kDepthUnit) uniform sampler2D depth;
layout(binding = kNormalUnit) uniform sampler2D normal_world_oct;
layout(binding = kAlbedoUnit) uniform sampler2D albedo;
layout(binding = kMaterialUnit) uniform sampler2D material;
layout(binding = kEmissionUnit) uniform sampler2D emission;
layout(binding = kIdUnit) uniform usampler2D id;
layout(binding = kTraceUnit) uniform usampler2D trace;
