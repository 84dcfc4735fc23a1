// Shadow maps as pictures: the maps of the first light side by side, near to the light bright; or the picture with the
// layer that answers at each pixel as a colour, a line where a texel of it ends.
#include "lib/debug_colors.glsl"
#include "lib/gbuffer.glsl"
#include "lib/shadow_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba8) writeonly uniform image2D picture;

vec3 mapColor(vec2 pixel) {
  ShadowMapLight light = shadowMaps.lights[0];
  if (light.layers.y == 0) return vec3(0.12);
  // Square maps in rows, as large as fit.
  vec2 size = vec2(frame.size.xy);
  int columns = light.layers.y == 1 ? 1 : light.layers.y == 4 ? 2 : 3, rows = (light.layers.y + columns - 1) / columns;
  float side = min(size.x / float(columns), size.y / float(rows));
  vec2 at = (pixel - 0.5 * (size - side * vec2(columns, rows))) / side;
  ivec2 cell = ivec2(floor(at));
  int number = (rows - 1 - cell.y) * columns + cell.x;
  if (any(lessThan(cell, ivec2(0))) || cell.x >= columns || cell.y >= rows || number >= light.layers.y) return vec3(0.12);
  int layer = light.layers.x + number;
  float depth = texelFetch(shadow_map, ivec3(fract(at) * float(shadowMaps.size.x), layer), 0).r;
  if (depth <= 0.0) return vec3(0.05, 0.08, 0.2);
  vec4 ends = shadowMaps.layers[layer].depth;
  float share = ends.z > 0.5 ? 1.0 - depth : (ends.x / depth - ends.x) / (ends.y - ends.x);
  return vec3(1.0 - 0.9 * clamp(share, 0.0, 1.0));
}

vec3 layerColor(ivec2 pixel) {
  if (kindOfId(texelFetch(id, pixel, 0).r) == KIND_NONE) return vec3(0.0);
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  float t = rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r);
  vec3 normal = directionFromOctahedral(texelFetch(normal_world_oct, pixel, 0).zw);
  float facing = 0.4 + 0.6 * abs(dot(normal, directionWorld));
  ShadowMapLight light = shadowMaps.lights[0];
  MapPoint point = mapPointAt(light, originEye + t * directionWorld, normal);
  if (point.layer < 0) return vec3(0.5) * facing;
  const vec3 colors[6] = vec3[](vec3(0.9, 0.25, 0.2), vec3(0.3, 0.75, 0.3), vec3(0.25, 0.45, 0.95), vec3(0.95, 0.8, 0.2),
                                vec3(0.8, 0.35, 0.85), vec3(0.25, 0.8, 0.85));
  ivec2 texel = ivec2(floor(point.texel / 8.0)); // fields of eight texels a side
  return colors[(point.layer - light.layers.x) % 6] * facing * ((texel.x + texel.y & 1) == 0 ? 1.0 : 0.8);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 color = frame.size.w == DEBUG_VIEW_SHADOW_MAP ? mapColor(vec2(pixel) + 0.5) : layerColor(pixel);
  imageStore(picture, pixel, vec4(color, 1.0));
}
