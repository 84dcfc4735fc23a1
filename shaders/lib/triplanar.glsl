// A glTF material on a surface without texture coordinates: its textures projected along the three axes of object space
// and blended by the normal (thesis 8.2.10). Twin: scene/triplanar.h.
//
//        +y                  On each side the texture stands upright for who looks at it from outside, +y up, and is never
//         |  -z              mirrored: u to the right, v downwards. From above -z is up, from below +z.
//         | /
//         +---- +x
#include "lib/material.glsl"

struct TriplanarPoint {
  vec3 pointObject;
  vec3 normalObject; // unit
  vec3 dx, dy;       // metres of object space to the pixels beside and above, on the surface
};

struct TriplanarSurface {
  vec4 baseColor;
  vec2 metallicRoughness;
  float occlusion;
  vec3 emission;
  vec3 normalObject; // bent by the normal map, unit
};

struct TriplanarSide {
  vec3 right, up;
};

TriplanarSide triplanarSide(int axis, vec3 normal) {
  float s = normal[axis] < 0.0 ? -1.0 : 1.0;
  if (axis == 0) return TriplanarSide(vec3(0.0, 0.0, -s), vec3(0.0, 1.0, 0.0));
  if (axis == 1) return TriplanarSide(vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -s));
  return TriplanarSide(vec3(s, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
}

vec4 triplanarUv(TriplanarSide side, vec3 offset, float metres) {
  vec2 uv = vec2(dot(offset, side.right), -dot(offset, side.up)) / metres;
  return vec4(uv, uv); // both sets are the same
}

// Fourth powers: where a side is the steepest by far it has its place alone, and corners blend within about 20 degrees.
vec3 triplanarWeights(vec3 normal) {
  vec3 squared = normal * normal, weights = squared * squared;
  return weights / (weights.x + weights.y + weights.z);
}

// The normal map in the side's frame, laid on the surface's own normal.
vec3 triplanarNormal(TriplanarSide side, vec3 normal, vec3 mapped) {
  vec3 tangent = side.right - normal * dot(normal, side.right);
  if (dot(tangent, tangent) <= 0.0) return normal;
  tangent = normalize(tangent);
  return normalize(mapped.x * tangent + mapped.y * cross(normal, tangent) + mapped.z * normal);
}

TriplanarSurface sampleTriplanar(MaterialRow m, TriplanarPoint at, float metres) {
  TriplanarSurface sum = TriplanarSurface(vec4(0.0), vec2(0.0), 0.0, vec3(0.0), vec3(0.0));
  vec3 weights = triplanarWeights(at.normalObject);
  for (int axis = 0; axis < 3; ++axis) {
    TriplanarSide side = triplanarSide(axis, at.normalObject);
    UvPixel uv = UvPixel(triplanarUv(side, at.pointObject, metres), triplanarUv(side, at.dx, metres), triplanarUv(side, at.dy, metres));
    float weight = weights[axis];
    sum.baseColor += weight * (usesTexture(m, MATERIAL_BASE_COLOR) ? MATERIAL_SAMPLE(m, MATERIAL_BASE_COLOR, uv) : vec4(1.0));
    sum.metallicRoughness += weight * (usesTexture(m, MATERIAL_METALLIC_ROUGHNESS) ? MATERIAL_SAMPLE(m, MATERIAL_METALLIC_ROUGHNESS, uv).bg : vec2(1.0));
    sum.occlusion += weight * (usesTexture(m, MATERIAL_OCCLUSION) ? MATERIAL_SAMPLE(m, MATERIAL_OCCLUSION, uv).r : 1.0);
    sum.emission += weight * (usesTexture(m, MATERIAL_EMISSION) ? MATERIAL_SAMPLE(m, MATERIAL_EMISSION, uv).rgb : vec3(1.0));
    vec3 mapped = usesTexture(m, MATERIAL_NORMAL) ? MATERIAL_SAMPLE(m, MATERIAL_NORMAL, uv).xyz * 2.0 - 1.0 : vec3(0.0, 0.0, 1.0);
    sum.normalObject += weight * triplanarNormal(side, at.normalObject, mapped * vec3(m.factors.zz, 1.0));
  }
  sum.baseColor *= m.baseColor;
  sum.metallicRoughness *= m.factors.xy;
  sum.occlusion = 1.0 + m.factors.w * (sum.occlusion - 1.0);
  sum.emission *= m.emission.rgb;
  sum.normalObject = dot(sum.normalObject, sum.normalObject) > 0.0 ? normalize(sum.normalObject) : at.normalObject;
  return sum;
}
