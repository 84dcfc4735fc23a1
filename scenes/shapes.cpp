// Parametric shapes: a grid over the unit square, bent. The implicit ones are in implicit_shapes.cpp.
#include "scenes/shapes.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

namespace brickfield::scenes {
namespace {

constexpr float kTau = glm::two_pi<float>();
/// Faces that meet at less than this angle are shaded as one surface: above the steps of our rounded edges.
constexpr float kCreaseDegrees = 40.0f;
/// Of tubes only the caps are set off, at about 90°; their ribs are not.
constexpr float kTubeCreaseDegrees = 75.0f;

float sign(float x) { return x < 0 ? -1.0f : 1.0f; }

/// Share of the profile's length at each point, 0 to 1.
std::vector<float> lengthShares(std::span<const glm::vec2> profile, bool closed) {
  std::vector<float> shares{0.0f};
  std::size_t count = profile.size() + (closed ? 1 : 0);
  for (std::size_t i = 1; i < count; ++i) {
    shares.push_back(shares.back() + glm::distance(profile[i % profile.size()], profile[i - 1]));
  }
  for (float& share : shares) share /= shares.back();
  return shares;
}

void capTube(Shape& shape, int sides, std::uint32_t firstVertex, glm::vec3 center, bool flipped) {
  auto centerVertex = static_cast<std::uint32_t>(shape.positions.size());
  shape.positions.push_back(center);
  shape.uvs.push_back(shape.uvs[firstVertex]);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sides); ++i) {
    std::uint32_t a = firstVertex + i;
    std::uint32_t b = a + 1;
    if (flipped) std::swap(a, b);
    shape.indices.insert(shape.indices.end(), {a, b, centerVertex});
  }
}

} // namespace

std::vector<glm::vec2> roundedProfile(std::span<const ProfileCorner> corners, int steps, bool closed) {
  std::vector<glm::vec2> profile;
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    bool isEnd = !closed && (i == 0 || i + 1 == count);
    if (isEnd || corners[i].rounding <= 0) {
      profile.push_back(corners[i].point);
      continue;
    }
    glm::vec2 corner = corners[i].point;
    glm::vec2 toPrevious = corners[(i + count - 1) % count].point - corner;
    glm::vec2 toNext = corners[(i + 1) % count].point - corner;
    float reach = std::min({corners[i].rounding, 0.49f * glm::length(toPrevious), 0.49f * glm::length(toNext)});
    glm::vec2 from = corner + reach * glm::normalize(toPrevious);
    glm::vec2 to = corner + reach * glm::normalize(toNext);
    for (int k = 0; k <= steps; ++k) {
      // Conic with the corner's weight 1/√2: a circle where the corner is square (Farin, rational quadratics).
      float t = static_cast<float>(k) / static_cast<float>(steps);
      float middle = 2 * t * (1 - t) * glm::one_over_root_two<float>();
      float ends = (1 - t) * (1 - t) + t * t;
      profile.push_back(((1 - t) * (1 - t) * from + middle * corner + t * t * to) / (ends + middle));
    }
  }
  return profile;
}

Shape revolvedShape(std::span<const glm::vec2> profile, bool closedProfile, int segments) {
  const std::vector<float> shares = lengthShares(profile, closedProfile);
  const int rows = static_cast<int>(shares.size()) - 1;
  GridTopology topology{true, closedProfile, !closedProfile && profile.front().x == 0,
                        !closedProfile && profile.back().x == 0};
  auto rowOf = [rows](float v) { return static_cast<std::size_t>(std::lround(v * static_cast<float>(rows))); };
  Shape shape = gridShape(segments, rows, topology, [&](float u, float v) {
    glm::vec2 point = profile[rowOf(v) % profile.size()];
    return glm::vec3(point.x * std::cos(kTau * u), point.y, point.x * std::sin(kTau * u));
  });
  for (glm::vec2& uv : shape.uvs) uv.y = shares[rowOf(uv.y)];
  orientOutward(shape);
  smoothNormals(shape, kCreaseDegrees);
  return shape;
}

Shape tubeShape(const TubeSettings& settings, const std::function<glm::vec3(float along)>& curve,
                const std::function<glm::vec3(float along)>& sideways,
                const std::function<float(float along, float aroundRadians)>& radius) {
  GridTopology topology{true, settings.closed, false, false};
  const float step = 0.25f / static_cast<float>(settings.steps);
  auto tangentAt = [&](float along) {
    float before = settings.closed ? along - step : std::max(along - step, 0.0f);
    float after = settings.closed ? along + step : std::min(along + step, 1.0f);
    return glm::normalize(curve(after) - curve(before));
  };
  Shape shape = gridShape(settings.sides, settings.steps, topology, [&](float u, float v) {
    glm::vec3 tangent = tangentAt(v);
    glm::vec3 side = sideways(v);
    side = glm::normalize(side - glm::dot(side, tangent) * tangent);
    glm::vec3 up = glm::cross(tangent, side);
    float angle = kTau * u;
    return curve(v) + radius(v, angle) * (std::cos(angle) * side + std::sin(angle) * up);
  });
  if (!settings.closed) {
    auto lastRow = static_cast<std::uint32_t>(settings.steps * (settings.sides + 1));
    capTube(shape, settings.sides, 0, curve(0), true);
    capTube(shape, settings.sides, lastRow, curve(1), false);
  }
  orientOutward(shape);
  smoothNormals(shape, kTubeCreaseDegrees);
  return shape;
}

Shape sphereShape(float radius, int segments, int rings) {
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= rings; ++i) {
    float angle = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
    bool isPole = i == 0 || i == rings;
    profile.push_back({isPole ? 0.0f : radius * std::sin(angle), radius * std::cos(angle)});
  }
  return revolvedShape(profile, false, segments);
}

Shape torusShape(float ringRadius, float tubeRadius, int steps, int sides) {
  return tubeShape(
      {steps, sides, true},
      [=](float along) { return ringRadius * glm::vec3(std::cos(kTau * along), 0, std::sin(kTau * along)); },
      [](float along) { return glm::vec3(std::cos(kTau * along), 0, std::sin(kTau * along)); },
      [=](float, float) { return tubeRadius; });
}

Shape trefoilShape(float ringRadius, float tubeRadius, int steps, int sides, float ribDepth) {
  // The axis goes twice around the ring while it goes three times around the ring's own tube.
  auto curve = [=](float along) {
    float around = 2 * kTau * along;
    float across = 3 * kTau * along;
    float distance = ringRadius * (1.0f + 0.45f * std::cos(across));
    return glm::vec3(distance * std::cos(around), 0.45f * ringRadius * std::sin(across), distance * std::sin(around));
  };
  auto fromTheRing = [=](float along) {
    float around = 2 * kTau * along;
    return curve(along) - ringRadius * glm::vec3(std::cos(around), 0, std::sin(around));
  };
  // The ribs wind twelve times around the tube on the way: a whole number, so that they close.
  return tubeShape({steps, sides, true}, curve, fromTheRing, [=](float along, float around) {
    return tubeRadius * (1.0f + ribDepth * std::cos(5 * around + 12 * kTau * along));
  });
}

Shape superellipsoidShape(glm::vec3 halfExtent, float exponent, int segments) {
  auto power = [exponent](float x) { return sign(x) * std::pow(std::abs(x), exponent); };
  Shape shape = gridShape(segments, segments / 2, {true, false, true, true}, [&](float u, float v) {
    float longitude = kTau * u;
    float latitude = glm::pi<float>() * (v - 0.5f);
    bool isPole = v == 0 || v == 1;
    float ring = isPole ? 0.0f : power(std::cos(latitude));
    return halfExtent *
           glm::vec3(ring * power(std::cos(longitude)), power(std::sin(latitude)), ring * power(std::sin(longitude)));
  });
  orientOutward(shape);
  smoothNormals(shape, kCreaseDegrees);
  return shape;
}

Shape roundedBoxShape(glm::vec3 halfExtent, float rounding, int steps) {
  // Along each axis: the rounded edge in equal angles, the flat, the other edge. The outermost offset is exactly the
  // rounding (tan 45° = 1), so that neighbouring faces meet in equal bits.
  std::vector<glm::vec2> offsets; // (which end of the flat, offset from it)
  for (int i = steps; i >= 0; --i) {
    float angle = glm::quarter_pi<float>() * static_cast<float>(i) / static_cast<float>(steps);
    offsets.push_back({-1.0f, -(i == steps ? rounding : rounding * std::tan(angle))});
  }
  for (int i = 0; i <= steps; ++i) offsets.push_back({1.0f, -offsets[static_cast<std::size_t>(steps - i)].y});

  const glm::vec3 flat = halfExtent - rounding;
  const int cells = static_cast<int>(offsets.size()) - 1;
  auto indexOf = [cells](float share) {
    return static_cast<std::size_t>(std::lround(share * static_cast<float>(cells)));
  };
  Shape box;
  for (int face = 0; face < 6; ++face) {
    int axis = face / 2;
    int axisU = (axis + 1) % 3;
    int axisV = (axis + 2) % 3;
    float side = face % 2 == 0 ? 1.0f : -1.0f;
    Shape part = gridShape(cells, cells, {}, [&](float u, float v) {
      glm::vec2 alongU = offsets[indexOf(u)];
      glm::vec2 alongV = offsets[indexOf(v)];
      glm::vec3 core(0), offset(0);
      core[axis] = side * flat[axis], core[axisU] = alongU.x * flat[axisU], core[axisV] = alongV.x * flat[axisV];
      offset[axis] = side * rounding, offset[axisU] = alongU.y, offset[axisV] = alongV.y;
      return core + rounding / glm::length(offset) * offset;
    });
    if (side < 0) flipTriangles(part);
    for (std::size_t i = 0; i < part.uvs.size(); ++i) {
      part.uvs[i] = 0.5f + 0.5f * glm::vec2(part.positions[i][axisU] / halfExtent[axisU],
                                            part.positions[i][axisV] / halfExtent[axisV]);
    }
    append(box, part);
  }
  smoothNormals(box, kCreaseDegrees);
  return box;
}

Shape podiumShape(float radius, float height, float rounding, int segments) {
  const ProfileCorner corners[] = {
      {{0, 0}}, {{radius, 0}, 0.3f * rounding}, {{radius, height}, rounding}, {{0, height}}};
  return revolvedShape(roundedProfile(corners, 6, false), false, segments);
}

Shape gearShape(const GearSettings& settings) {
  // Section in (share of the way from bore to outline, height): a closed loop, lofted around with the outline's radius.
  const float h = settings.halfThickness;
  const float depth = 0.35f * h;
  const float reach = settings.rootRadius - settings.boreRadius;
  const float r = settings.rounding;
  std::vector<ProfileCorner> corners{{{0.0f, -h}, r},          {{0.25f, -h}, r}, {{0.32f, -h + depth}, r},
                                     {{0.68f, -h + depth}, r}, {{0.75f, -h}, r}, {{1.0f, -h}, r},
                                     {{1.0f, h}, r},           {{0.75f, h}, r},  {{0.68f, h - depth}, r},
                                     {{0.32f, h - depth}, r},  {{0.25f, h}, r},  {{0.0f, h}, r}};
  for (ProfileCorner& corner : corners) corner.point.x *= reach;
  const std::vector<glm::vec2> section = roundedProfile(corners, 4, true);

  auto outlineRadius = [&](float angle) {
    // A cosine pushed into flanks, roots and tips by a steep smooth step.
    float wave = std::cos(static_cast<float>(settings.teeth) * angle);
    float share = 0.5f + 0.5f * std::tanh(2.6f * wave) / std::tanh(2.6f);
    return settings.rootRadius + (settings.tipRadius - settings.rootRadius) * share;
  };
  const int rows = static_cast<int>(section.size());
  const int columns = settings.teeth * 16;
  Shape shape = gridShape(columns, rows, {true, true, false, false}, [&](float u, float v) {
    glm::vec2 point = section[static_cast<std::size_t>(std::lround(v * static_cast<float>(rows))) % section.size()];
    float angle = kTau * u;
    // Only the outermost quarter follows the teeth; hub and recess stay round.
    float toTeeth = std::clamp((point.x / reach - 0.75f) / 0.25f, 0.0f, 1.0f);
    float radius = settings.boreRadius + point.x + toTeeth * (outlineRadius(angle) - settings.rootRadius);
    return glm::vec3(radius * std::cos(angle), point.y, radius * std::sin(angle));
  });
  orientOutward(shape);
  smoothNormals(shape, kCreaseDegrees);
  return shape;
}

} // namespace brickfield::scenes
