// Cascades in double precision: snapping to texels leaves no digits to spare far from the origin.
#include "scene/shadow_views.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace brickfield {

namespace {

// Wider spots would see their borders at more than five times the texels of their middle.
constexpr float kWidestSpotRadians = 1.3962634f; // 80 degrees

std::array<glm::dvec3, 8> cornersOf(const Box& box) {
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = {(i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y, (i & 4 ? box.max : box.min).z};
  return corners;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void extend(double value) { low = std::min(low, value), high = std::max(high, value); }
  double middle() const { return 0.5 * (low + high); }
  double half() const { return 0.5 * (high - low); }
};

Range rangeAlong(const Box& box, glm::dvec3 direction, glm::dvec3 origin) {
  Range range;
  for (const glm::dvec3& corner : cornersOf(box)) range.extend(glm::dot(corner - origin, direction));
  return range;
}

struct Sphere {
  glm::dvec3 center;
  double radius;
};

// Around a slice of the camera's frustum; the radius depends on the lens and the cuts alone.
Sphere sphereOfSlice(const View& camera, double nearDepth, double farDepth) {
  const glm::dvec2 half(1.0 / camera.clipFromView[0][0], 1.0 / camera.clipFromView[1][1]);
  const double k2 = glm::dot(half, half);
  double depth = 0.5 * (nearDepth + farDepth), radius = 0;
  if (camera.orthographic) {
    radius = std::sqrt(0.25 * (farDepth - nearDepth) * (farDepth - nearDepth) + k2);
  } else {
    depth = std::min(farDepth, depth * (1.0 + k2)); // as far from the near corners as from the far ones
    radius = std::sqrt((farDepth - depth) * (farDepth - depth) + k2 * farDepth * farDepth);
  }
  const glm::dvec3 forward = -glm::dvec3(camera.worldFromView[2]);
  return {glm::dvec3(camera.eyeWorld) + depth * forward, radius};
}

// A square map with room for the filters around what must be in it.
double withMargin(double halfExtent, int texels) { return halfExtent * texels / (texels - 2.0 * kShadowMarginTexels); }

std::vector<ShadowView> makeCascades(glm::vec3 directionWorld, const View& camera, const Box& bounds, int texels) {
  const glm::dvec3 direction(directionWorld);
  const glm::uvec2 size(static_cast<std::uint32_t>(texels));
  const glm::dmat3 axes(makeParallelView(glm::dvec3(0), direction, 1, 0, 1, size).worldFromView);
  const Range x = rangeAlong(bounds, axes[0], glm::dvec3(0)), y = rangeAlong(bounds, axes[1], glm::dvec3(0)),
              z = rangeAlong(bounds, axes[2], glm::dvec3(0));
  const double sceneHalf = std::max({x.half(), y.half(), 1e-6});
  // What is baked may stand out of its mesh by a little.
  const double top = z.high + 0.02 * sceneHalf + 0.01 * z.half(), bottom = z.low - 0.02 * sceneHalf - 0.01 * z.half();
  const std::vector<double> ends = cascadeEnds(camera, bounds);
  std::vector<ShadowView> views;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Sphere sphere = sphereOfSlice(camera, ends[i], ends[i + 1]);
    glm::dvec2 center(glm::dot(sphere.center, axes[0]), glm::dot(sphere.center, axes[1]));
    double half = sphere.radius;
    const bool holdsScene = half >= sceneHalf;
    if (holdsScene) center = {x.middle(), y.middle()}, half = sceneHalf;
    half = withMargin(half, texels);
    const double texel = 2.0 * half / texels;
    center = glm::floor(center / texel + 0.5) * texel;
    const glm::dvec3 eye = axes * glm::dvec3(center, top);
    views.push_back({makeParallelView(eye, direction, half, 0.0, top - bottom, size), static_cast<float>(top - bottom),
                     static_cast<float>(texel), holdsScene});
  }
  return views;
}

ShadowView makePerspective(const PosedLight& light, glm::vec3 forward, double tangent, const Box& bounds, int texels) {
  const glm::vec3 position = light.positionWorld;
  double farthest = 0;
  for (const glm::dvec3& corner : cornersOf(bounds))
    farthest = std::max(farthest, glm::distance(corner, glm::dvec3(position)));
  // Inside of a sphere light nothing casts shadows.
  const double nearest = std::max<double>(light.light.kind == LightKind::Sphere ? light.light.radius : 0.0,
                                          1e-4 * std::max(farthest, 1e-3));
  tangent = withMargin(tangent, texels);
  const View view = makePerspectiveView(position, position + forward, static_cast<float>(2.0 * std::atan(tangent)),
                                        static_cast<float>(nearest), glm::uvec2(static_cast<std::uint32_t>(texels)));
  return {view, static_cast<float>(std::max(farthest, 2.0 * nearest)), static_cast<float>(2.0 * tangent / texels)};
}

} // namespace

ShadowLayout shadowLayoutOf(const Light& light) {
  if (light.kind == LightKind::Sun) return ShadowLayout::Cascades;
  const bool narrow = light.kind == LightKind::Spot && light.outerConeRadians <= kWidestSpotRadians;
  return narrow ? ShadowLayout::Spot : ShadowLayout::Cube;
}

std::vector<double> cascadeEnds(const View& camera, const Box& boundsWorld) {
  const Range depth = rangeAlong(boundsWorld, -glm::dvec3(camera.worldFromView[2]), glm::dvec3(camera.eyeWorld));
  const auto rounded = [](double value, auto round) { return std::exp2(0.25 * round(4.0 * std::log2(value))); };
  const auto up = [](double v) { return std::ceil(v); };
  const auto down = [](double v) { return std::floor(v); };
  const double least = std::max<double>(camera.nearDistance, 1e-6);
  const double last = rounded(std::max(depth.high, 2.0 * least), up);
  constexpr double kMostRatio = 200; // of far to near: texels would be wasted on what is nearer
  const double first = rounded(std::max({depth.low, least, last / kMostRatio}), down);
  // Three parts of the logarithmic and one of the even split (Zhang and others 2006).
  constexpr double kLogarithmic = 0.75;
  std::vector<double> ends{0.0};
  for (int i = 1; i <= kSunCascades; ++i) {
    const double share = static_cast<double>(i) / kSunCascades;
    ends.push_back(kLogarithmic * first * std::pow(last / first, share) +
                   (1 - kLogarithmic) * (first + share * (last - first)));
  }
  if (depth.low > least) ends.front() = first;
  return ends;
}

std::vector<ShadowView> makeShadowViews(const PosedLight& light, const View& camera, const Box& boundsWorld,
                                        int texels) {
  switch (shadowLayoutOf(light.light)) {
  case ShadowLayout::Cascades:
    return makeCascades(light.directionWorld, camera, boundsWorld, texels);
  case ShadowLayout::Spot:
    return {makePerspective(light, light.directionWorld, std::tan(light.light.outerConeRadians), boundsWorld, texels)};
  case ShadowLayout::Cube:
    break;
  }
  std::vector<ShadowView> faces;
  for (int face = 0; face < kCubeFaces; ++face) {
    glm::vec3 forward(0);
    forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
    faces.push_back(makePerspective(light, forward, 1.0, boundsWorld, texels));
  }
  return faces;
}

} // namespace brickfield
