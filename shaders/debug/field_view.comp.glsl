// The world field as a picture: a plane cut through it, as computed tomography shows a body, or its surface as the
// camera sees it, traced in the field alone.
#include "lib/debug_colors.glsl"
#include "lib/frame.glsl"
#include "lib/world_field_nodes.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba8) writeonly uniform image2D picture;
// Tiles of this frame, ascending: those whose surface keys, candidates and values were made.
layout(std430, binding = kFieldShownListBinding) readonly buffer KeyTileBlock { uint keyTiles[]; };
layout(std430, binding = kFieldShownListBinding + 1) readonly buffer CandidateTileBlock { uint candidateTiles[]; };
layout(std430, binding = kFieldShownListBinding + 2) readonly buffer ValueTileBlock { uint valueTiles[]; };

uniform vec3 centerAnchored; // of the picture
uniform vec3 rightAnchored;  // metres a pixel
uniform vec3 upAnchored;
uniform int shownCascade; // -1: the finest at each point
uniform uvec3 tileCounts;

const vec3 NOTHING = vec3(0.12);
const float ISO_TEXELS = 4.0; // from line to line

// Like readWorldField, or of the one cascade that is asked for. Texels; false where it holds nothing.
bool readShown(vec3 point, out float texels, out int cascade) {
  if (shownCascade < 0) {
    FieldReading reading = readWorldField(point);
    cascade = reading.cascade;
    texels = cascade < 0 ? 0.0 : reading.distanceWorld * field.cascades[cascade].texel.y;
    return cascade >= 0;
  }
  cascade = shownCascade;
  vec3 lattice = point * field.cascades[cascade].texel.y;
  texels = fieldTexels(cascade, lattice);
  return isHeldByField(fieldDepth(cascade, lattice));
}

// range  of the texels; where the field ends at it there is no line
vec3 distanceColor(float texels, float pixelTexels, float range) {
  float fade = 1.0 - exp(-abs(texels) / 10.0);
  vec3 color = texels < 0.0 ? mix(vec3(1.0, 0.72, 0.3), vec3(0.8, 0.1, 0.05), fade)
                            : mix(vec3(1.0), vec3(0.3, 0.5, 0.85), fade);
  float toLine = abs(texels - ISO_TEXELS * round(texels / ISO_TEXELS));
  // Lines that stand closer than six pixels would be a grey veil.
  bool isLine = toLine < 0.5 * pixelTexels && abs(texels) < range - 0.01;
  if (6.0 * pixelTexels < ISO_TEXELS && isLine) color *= 0.72;
  return abs(texels) < 0.9 * pixelTexels ? vec3(0.0) : color;
}

uint tileListed(uint list, uint i) { return list == 0u ? keyTiles[i] : list == 1u ? candidateTiles[i] : valueTiles[i]; }

bool isListed(uint list, uint word) {
  uint first = 0u, end = tileCounts[list];
  while (first < end) {
    uint middle = (first + end) / 2u;
    if (tileListed(list, middle) < word) first = middle + 1u;
    else end = middle;
  }
  return first < tileCounts[list] && tileListed(list, first) == word;
}

// Crimson: keys made anew; yellow: candidates; green: values alone, for SDF objects; grey: kept. Over the distance's own shades.
vec3 tileColor(int cascade, vec3 point, vec3 underlay) {
  ivec3 lattice = ivec3(floor(point * field.cascades[cascade].texel.y));
  uint word = uint(cascade) << 24 | tileSlot(field.cascades[cascade], lattice >> 3);
  vec3 color = isListed(0u, word)   ? vec3(0.9, 0.2, 0.15)
               : isListed(1u, word) ? vec3(0.95, 0.8, 0.2)
               : isListed(2u, word) ? vec3(0.3, 0.75, 0.35)
                                    : vec3(0.6);
  bool isOdd = ((lattice.x >> 3 ^ lattice.y >> 3 ^ lattice.z >> 3) & 1) != 0;
  return color * (isOdd ? 0.85 : 1.0) * (0.35 + 0.65 * dot(underlay, vec3(0.3333)));
}

vec3 sliceColor(ivec2 pixel) {
  vec2 fromCenter = vec2(pixel) + 0.5 - 0.5 * vec2(frame.size.xy);
  vec3 point = centerAnchored + fromCenter.x * rightAnchored + fromCenter.y * upAnchored;
  float texels;
  int cascade;
  if (!readShown(point, texels, cascade)) return NOTHING;
  float pixelTexels = length(rightAnchored) * field.cascades[cascade].texel.y;
  vec3 color = distanceColor(texels, pixelTexels, field.cascades[cascade].texel.z);
  if (frame.size.w == DEBUG_VIEW_FIELD_TILES) return tileColor(cascade, point, color);
  if (frame.size.w == DEBUG_VIEW_FIELD_ID && abs(texels) >= 0.9 * pixelTexels) {
    uint node = fieldNode(point);
    return node == FIELD_NODE_UNCERTAIN ? vec3(0.5) : node == 0u ? NOTHING : idColor(node - 1u);
  }
  return color;
}

// Steps by the field until its surface is nearer than a twentieth of a texel: a sheet between two texel centres may
// touch zero no more closely than its half precision floats allow.
vec3 surfaceColor(ivec2 pixel) {
  const float HIT_TEXELS = 0.05, LEAST_STEP_TEXELS = 0.05;
  const int MOST_STEPS = 512;
  vec3 originEye, direction;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, direction);
  vec3 origin = originEye + frame.eyeAnchored.xyz;
  FieldCascade coarsest = field.cascades[int(field.counts.x) - 1];
  vec3 windowExtent = fieldExtent(int(field.counts.x) - 1) * coarsest.texel.x;
  float farthest = distance(origin, vec3(coarsest.window.xyz) * coarsest.texel.x + 0.5 * windowExtent) + length(windowExtent);
  float t = rayParameterOfNear(direction);
  bool isOutside = false; // an eye inside looks out first
  for (int i = 0; i < MOST_STEPS && t < farthest; ++i) {
    vec3 point = origin + t * direction;
    FieldReading reading = readWorldField(point);
    float texel = field.cascades[reading.cascade < 0 ? int(field.counts.x) - 1 : reading.cascade].texel.x;
    isOutside = isOutside || reading.distanceWorld > HIT_TEXELS * texel;
    if (isOutside && reading.cascade >= 0 && reading.distanceWorld < HIT_TEXELS * texel) {
      vec3 normal = fieldGradient(point);
      normal /= max(length(normal), 1e-6);
      float facing = max(dot(normal, -direction), 0.0), sky = 0.5 + 0.5 * normal.y;
      return vec3(0.12, 0.13, 0.15) + vec3(0.55, 0.53, 0.5) * facing + vec3(0.2, 0.25, 0.3) * sky;
    }
    t += max(abs(reading.distanceWorld), LEAST_STEP_TEXELS * texel);
  }
  return vec3(0.08, 0.1, 0.16);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 color = frame.size.w == DEBUG_VIEW_FIELD_SURFACE ? surfaceColor(pixel) : sliceColor(pixel);
  imageStore(picture, pixel, vec4(color, 1.0));
}
