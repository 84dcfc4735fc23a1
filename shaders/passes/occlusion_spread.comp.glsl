// From occlusion traced at every scale-th pixel to that of every pixel: the mean over a square as large as the pattern
// of directions, of what lies on about the same plane (bilateral: distance to the plane, and normal). The square's
// border moves smoothly, so that nothing steps from pixel to pixel. A pixel like none around it is traced itself.
#include "lib/gbuffer.glsl"
#include "lib/occlusion_code.glsl"
#include "lib/occlusion_group.glsl"
#include "shared/sdf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef COUNTERS_ON
layout(std430, binding = kPassBufferABinding) buffer CounterBlock { uint counters[]; };
#endif
layout(binding = kOcclusionTracedUnit) uniform usampler2D occlusion_traced;
layout(binding = 0, r8) writeonly uniform image2D occlusion;

uniform int occlusionForm, occlusionCones, occlusionScale;
uniform float occlusionRadius;

// Of the square's width: what is as far from the plane counts no more.
const float MOST_OFF_PLANE = 0.1;
const float LEAST_NORMAL_COSINE = 0.8;
// Of a place's weight for each place that it lies from the square's middle, along both axes. At quarter resolution the
// square is as wide as sixteen pixels, over which occlusion changes; at half the mean of all differs less from the truth.
const float QUARTER_FALL = 0.333;
// Of the places in the square; with less the mean would be noise.
const float LEAST_SUM = 1.0;

// What the group's pixels read of the traced ones, from the lowest place of the first pixel's square on.
const int GROUP = 8, MOST_SIDE = GROUP + OCCLUSION_PATTERN_SIDE + 1;
shared vec4 tracedPoint[MOST_SIDE * MOST_SIDE];  // eye space; w: open share
shared vec3 tracedNormal[MOST_SIDE * MOST_SIDE]; // 0 where nothing was traced, which is like nothing

struct PixelPoint {
  vec3 pointEye;
  vec3 normal;
  float reach; // metres, across the square
};

// Lowest place of a pixel's square, and how far beyond it the square begins.
ivec2 squareCorner(ivec2 pixel, out vec2 part) {
  vec2 first = vec2(pixel - occlusionScale / 2) / float(occlusionScale) - 0.5 * float(OCCLUSION_PATTERN_SIDE) + 0.5;
  part = fract(first);
  return ivec2(floor(first));
}

int sideOfGroup() { return (GROUP + occlusionScale - 1) / occlusionScale + OCCLUSION_PATTERN_SIDE + 1; }

void loadTraced(ivec2 firstPlace) {
  int side = sideOfGroup();
  ivec2 last = textureSize(occlusion_traced, 0) - 1;
  for (int i = int(gl_LocalInvocationIndex); i < side * side; i += GROUP * GROUP) {
    ivec2 place = firstPlace + ivec2(i % side, i / side);
    tracedPoint[i] = vec4(0.0);
    tracedNormal[i] = vec3(0.0);
    if (any(lessThan(place, ivec2(0))) || any(greaterThan(place, last))) continue;
    TracedOcclusion traced = occlusionOfCode(texelFetch(occlusion_traced, place, 0).rg);
    if (isinf(traced.t)) continue;
    vec3 originEye, directionWorld;
    viewRay(ndcFromPixel(vec2(pixelOfTraced(place, occlusionScale, ivec2(frame.size.xy))) + 0.5), originEye, directionWorld);
    tracedPoint[i] = vec4(originEye + traced.t * directionWorld, traced.open);
    tracedNormal[i] = traced.normal;
  }
  barrier();
}

float likeness(PixelPoint pixel, vec3 pointEye, vec3 normal) {
  float off = abs(dot(pixel.normal, pointEye - pixel.pointEye));
  return clamp(2.0 - 2.0 * off / (MOST_OFF_PLANE * pixel.reach), 0.0, 1.0) *
         clamp((dot(pixel.normal, normal) - LEAST_NORMAL_COSINE) / (1.0 - LEAST_NORMAL_COSINE) * 2.0, 0.0, 1.0);
}

// returns the mean of what is like the pixel; less than 0 where too little is
float spreadTo(ivec2 pixel, PixelPoint point, ivec2 firstPlace) {
  vec2 part;
  ivec2 corner = squareCorner(pixel, part) - firstPlace;
  int side = sideOfGroup();
  float sum = 0.0, weights = 0.0, fall = occlusionScale == 4 ? QUARTER_FALL : 0.0;
  vec2 middle = part + 0.5 * float(OCCLUSION_PATTERN_SIDE - 1);
  for (int y = 0; y <= OCCLUSION_PATTERN_SIDE; ++y)
    for (int x = 0; x <= OCCLUSION_PATTERN_SIDE; ++x) {
      int i = (corner.y + y) * side + corner.x + x;
      vec2 within = mix(vec2(1.0), mix(1.0 - part, part, greaterThan(ivec2(x, y), ivec2(0))),
                        equal(ivec2(x, y) % OCCLUSION_PATTERN_SIDE, ivec2(0)));
      vec2 nearness = (1.0 - fall * abs(vec2(x, y) - middle)) / (1.0 - fall); // 1 on average
      float weight = within.x * within.y * nearness.x * nearness.y * likeness(point, tracedPoint[i].xyz, tracedNormal[i]);
      sum += weight * tracedPoint[i].w;
      weights += weight;
    }
  return weights >= LEAST_SUM ? sum / weights : -1.0;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  vec2 part;
  ivec2 firstPlace = squareCorner(ivec2(gl_WorkGroupID.xy) * GROUP, part);
  if (gl_LocalInvocationIndex == 0u) askedCount = 0u;
  loadTraced(firstPlace);
  bool isPixel = all(lessThan(pixel, ivec2(frame.size.xy)));
  float open = 1.0;
  uint own = 0u;
  if (isPixel && kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE) {
    vec3 originEye, directionWorld;
    viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
    float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
    vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
    float pixelMetres = 2.0 / (frame.projection.y * float(frame.size.y)) * (frame.projection.z > 0.5 ? 1.0 : t);
    float reach = pixelMetres * float(occlusionScale * OCCLUSION_PATTERN_SIDE);
    PixelPoint point = PixelPoint(originEye + t * directionWorld, normal, reach);
    open = spreadTo(pixel, point, firstPlace);
    if (open < 0.0) own = askOcclusion(point.pointEye + frame.eyeAnchored.xyz, normal, cellOfTraced(pixel));
  }
  barrier();
  traceAsked(OcclusionSearch(occlusionForm, occlusionCones, occlusionRadius));
  barrier();
#ifdef COUNTERS_ON
  atomicAdd(counters[COUNTER_OCCLUSION_READS], occlusionReads);
#endif
  if (isPixel) imageStore(occlusion, pixel, vec4(open < 0.0 ? openOfAsked(own) : open, 0.0, 0.0, 0.0));
}
