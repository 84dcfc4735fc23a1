// Lists the pixels whose reflected rays are traced; for each of the others, which traced ones stand for it: those of the
// four around it that lie on about the same plane and are as smooth as it.
#include "lib/reflected_pixel.glsl"
#include "lib/reflection_code.glsl"
#include "lib/work_list_append.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0, rgba32ui) writeonly uniform uimage2D reflection_hit;

// Of bilinear weights what must be alike, lest one neighbour stands for all.
const float LEAST_ALIKE = 0.4;

bool isTracedPlace(ivec2 pixel) { return all(equal(pixel % scale, ivec2(0))); }

// Weights of the four traced pixels around one; all 0 where it must be traced itself.
vec4 weightsAround(ivec2 pixel, ReflectedPixel own) {
  vec2 part = vec2(pixel % scale) / float(scale);
  vec4 weights;
  for (int i = 0; i < 4; ++i) {
    vec2 near = mix(1.0 - part, part, vec2(i & 1, i >> 1));
    float weight = near.x * near.y;
    weights[i] = weight > 0.0 && isAlike(own, reflectedPixel(tracedPlace(pixel, scale, i))) ? weight : 0.0;
  }
  float sum = dot(weights, vec4(1.0));
  return sum < LEAST_ALIKE ? vec4(0.0) : weights / sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool isTraced = false;
  if (all(lessThan(pixel, ivec2(frame.size.xy)))) {
    ReflectedPixel own = reflectedPixel(pixel);
    vec4 weights = own.isMirror && !isTracedPlace(pixel) ? weightsAround(pixel, own) : vec4(0.0);
    isTraced = own.isMirror && weights == vec4(0.0);
    if (!isTraced) imageStore(reflection_hit, pixel, codeOfWeights(weights));
  }
  appendWork(isTraced, entryOfPixel(pixel), REFLECTION_GROUP);
}
