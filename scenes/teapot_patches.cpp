// The published control points, written down by what they are: the bodies of revolution as profiles (Newell's circles
// put the inner control points at 0.56 of the radius), handle and spout as cross-sections that are mirrored in y.
#include "scenes/teapot_patches.h"

#include <cmath>
#include <map>

namespace brickfield::scenes {
namespace {

struct ProfilePoint {
  float radius;
  float height;
  float quarterRatio = 0.56f; ///< 0.45 / 0.8 at the knob, whose published points are rounded
};
using Profile = std::array<ProfilePoint, 4>;

constexpr Profile kRim{{{1.4f, 2.4f}, {1.3375f, 2.53125f}, {1.4375f, 2.53125f}, {1.5f, 2.4f}}};
constexpr Profile kBodyUpper{{{1.5f, 2.4f}, {1.75f, 1.875f}, {2.0f, 1.35f}, {2.0f, 0.9f}}};
constexpr Profile kBodyLower{{{2.0f, 0.9f}, {2.0f, 0.45f}, {1.5f, 0.225f}, {1.5f, 0.15f}}};
constexpr Profile kLidKnob{{{0.0f, 3.15f}, {0.8f, 3.15f, 0.5625f}, {0.0f, 2.85f}, {0.2f, 2.7f}}};
constexpr Profile kLid{{{0.2f, 2.7f}, {0.4f, 2.55f}, {1.3f, 2.55f}, {1.3f, 2.4f}}};
constexpr Profile kBottom{{{1.5f, 0.15f}, {1.5f, 0.075f}, {1.425f, 0.0f}, {0.0f, 0.0f}}};

/// A row of a tube: the side towards the body's axis, the side away from it, half the width.
struct TubeRow {
  glm::vec2 inner; ///< (x, z)
  glm::vec2 outer;
  float halfWidth;
};
using Tube = std::array<TubeRow, 7>;

constexpr Tube kHandle{{{{-1.6f, 2.025f}, {-1.5f, 2.25f}, 0.3f},
                        {{-2.3f, 2.025f}, {-2.5f, 2.25f}, 0.3f},
                        {{-2.7f, 2.025f}, {-3.0f, 2.25f}, 0.3f},
                        {{-2.7f, 1.8f}, {-3.0f, 1.8f}, 0.3f},
                        {{-2.7f, 1.575f}, {-3.0f, 1.35f}, 0.3f},
                        {{-2.5f, 1.125f}, {-2.65f, 0.9375f}, 0.3f},
                        {{-2.0f, 0.9f}, {-1.9f, 0.6f}, 0.3f}}};
constexpr Tube kSpout{{{{1.7f, 1.425f}, {1.7f, 0.6f}, 0.66f},
                       {{2.6f, 1.425f}, {3.1f, 0.825f}, 0.66f},
                       {{2.3f, 2.1f}, {2.4f, 2.025f}, 0.25f},
                       {{2.7f, 2.4f}, {3.3f, 2.4f}, 0.25f},
                       {{2.8f, 2.475f}, {3.525f, 2.49375f}, 0.25f},
                       {{2.9f, 2.475f}, {3.45f, 2.5125f}, 0.15f},
                       {{2.8f, 2.4f}, {3.2f, 2.4f}, 0.15f}}};

/// Quarter of a circle from direction `quarter` clockwise as seen from above.
std::array<glm::vec3, 4> quarterCircle(ProfilePoint point, int quarter) {
  static constexpr std::array<glm::vec2, 5> kAxes{{{1, 0}, {0, -1}, {-1, 0}, {0, 1}, {1, 0}}};
  glm::vec2 from = kAxes[static_cast<std::size_t>(quarter)] * point.radius;
  glm::vec2 to = kAxes[static_cast<std::size_t>(quarter) + 1] * point.radius;
  float ratio = point.quarterRatio;
  return {
      {{from, point.height}, {from + ratio * to, point.height}, {to + ratio * from, point.height}, {to, point.height}}};
}

void addRevolution(std::vector<BezierPatch>& patches, TeapotPart part, const Profile& profile) {
  for (int quarter = 0; quarter < 4; ++quarter) {
    BezierPatch patch{part, quarter, 0, {}};
    for (std::size_t row = 0; row < 4; ++row) patch.rows[row] = quarterCircle(profile[row], quarter);
    patches.push_back(patch);
  }
}

void addTube(std::vector<BezierPatch>& patches, TeapotPart part, const Tube& tube) {
  for (int segment = 0; segment < 2; ++segment) {
    for (int half = 0; half < 2; ++half) {
      BezierPatch patch{part, half, segment, {}};
      for (std::size_t row = 0; row < 4; ++row) {
        const TubeRow& section = tube[static_cast<std::size_t>(3 * segment) + row];
        glm::vec2 first = half == 0 ? section.inner : section.outer;
        glm::vec2 last = half == 0 ? section.outer : section.inner;
        float y = half == 0 ? -section.halfWidth : section.halfWidth;
        patch.rows[row] = {{{first.x, 0, first.y}, {first.x, y, first.y}, {last.x, y, last.y}, {last.x, 0, last.y}}};
      }
      patches.push_back(patch);
    }
  }
}

/// Bernstein polynomials of degree 3. At t = 0 and 1 exactly one of them is 1 and the others 0, and B_i(t) of one side
/// equals B_3-i(1 - t) of the other, so that patches that share a border meet without a crack.
std::array<float, 4> bernstein(float t) {
  float s = 1.0f - t;
  return {s * s * s, 3.0f * t * (s * s), 3.0f * s * (t * t), t * t * t};
}

std::array<float, 4> bernsteinDerivative(float t) {
  float s = 1.0f - t;
  return {-3.0f * s * s, 3.0f * s * s - 6.0f * t * s, 6.0f * t * s - 3.0f * t * t, 3.0f * t * t};
}

glm::vec3 combine(const BezierPatch& patch, const std::array<float, 4>& weightsU,
                  const std::array<float, 4>& weightsV) {
  glm::vec3 sum(0);
  for (std::size_t row = 0; row < 4; ++row) {
    glm::vec3 acrossRow(0);
    for (std::size_t column = 0; column < 4; ++column) acrossRow += weightsU[column] * patch.rows[row][column];
    sum += weightsV[row] * acrossRow;
  }
  return sum;
}

glm::vec3 yUpFromZUp(glm::vec3 p) { return {p.x, p.z, -p.y}; }

bool isTube(TeapotPart part) { return part == TeapotPart::Handle || part == TeapotPart::Spout; }

/// Texture coordinates of a point of a patch; see teapotTextureRows.
glm::vec2 textureUv(const BezierPatch& patch, float u, float v) {
  glm::vec2 rows = teapotTextureRows(patch.part);
  float around = (static_cast<float>(patch.quarter) + u) / (isTube(patch.part) ? 2.0f : 4.0f);
  float along = isTube(patch.part) ? (static_cast<float>(patch.segment) + v) / 2.0f : v;
  return {around, rows.x + (rows.y - rows.x) * along};
}

Shape patchShape(const BezierPatch& patch, int cells) {
  // A pole row collapses by itself: its four control points are one, and the grid leaves out triangles without area
  // only when their bits are equal. So poles are named.
  GridTopology topology;
  topology.poleAtStart = patch.part == TeapotPart::LidKnob;
  topology.poleAtEnd = patch.part == TeapotPart::Bottom;
  Shape shape = gridShape(cells, cells, topology,
                          [&](float u, float v) { return yUpFromZUp(evaluatePatch(patch, u, v).position); });
  for (glm::vec2& uv : shape.uvs) uv = textureUv(patch, uv.x, uv.y);
  return shape;
}

/// A fan from the mean of a loop of positions to the loop.
Shape capShape(const std::vector<glm::vec3>& loop, glm::vec2 uv) {
  Shape shape;
  glm::vec3 center(0);
  for (glm::vec3 p : loop) center += p / static_cast<float>(loop.size());
  shape.positions = loop;
  shape.positions.push_back(center);
  shape.uvs.assign(shape.positions.size(), uv);
  auto count = static_cast<std::uint32_t>(loop.size());
  for (std::uint32_t i = 0; i < count; ++i) shape.indices.insert(shape.indices.end(), {i, (i + 1) % count, count});
  return shape;
}

/// Positions along one row of all patches of a part, once around.
std::vector<glm::vec3> rowLoop(const std::vector<BezierPatch>& patches, TeapotPart part, int segment, float v,
                               int cells) {
  std::vector<glm::vec3> loop;
  for (const BezierPatch& patch : patches) {
    if (patch.part != part || patch.segment != segment) continue;
    for (int i = 0; i < cells; ++i) {
      float u = static_cast<float>(i) / static_cast<float>(cells);
      loop.push_back(yUpFromZUp(evaluatePatch(patch, u, v).position));
    }
  }
  return loop;
}

/// The flat ring between the lid's edge and the rim's inner edge.
Shape lidGap(const std::vector<BezierPatch>& patches, int cells) {
  std::vector<glm::vec3> inner = rowLoop(patches, TeapotPart::Lid, 0, 1, cells);
  std::vector<glm::vec3> outer = rowLoop(patches, TeapotPart::Rim, 0, 0, cells);
  Shape shape;
  shape.positions = inner;
  shape.positions.insert(shape.positions.end(), outer.begin(), outer.end());
  shape.uvs.assign(shape.positions.size(), glm::vec2(0.5f, teapotTextureRows(TeapotPart::Lid).y));
  auto count = static_cast<std::uint32_t>(inner.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t next = (i + 1) % count;
    shape.indices.insert(shape.indices.end(), {i, count + next, count + i, i, next, count + next});
  }
  return shape;
}

/// Patches of a tube with both ends closed.
Shape tubeShell(const std::vector<BezierPatch>& patches, TeapotPart part, int cells) {
  Shape shell;
  for (const BezierPatch& patch : patches) {
    if (patch.part == part) append(shell, patchShape(patch, cells));
  }
  glm::vec2 rows = teapotTextureRows(part);
  std::vector<glm::vec3> first = rowLoop(patches, part, 0, 0, cells);
  std::vector<glm::vec3> last = rowLoop(patches, part, 1, 1, cells);
  Shape firstCap = capShape(first, {0.5f, rows.x});
  flipTriangles(firstCap); // the row runs along the fan's own direction at one end, against it at the other
  append(shell, firstCap);
  append(shell, capShape(last, {0.5f, rows.y}));
  return shell;
}

} // namespace

std::vector<BezierPatch> teapotPatches() {
  std::vector<BezierPatch> patches;
  addRevolution(patches, TeapotPart::Rim, kRim);
  addRevolution(patches, TeapotPart::BodyUpper, kBodyUpper);
  addRevolution(patches, TeapotPart::BodyLower, kBodyLower);
  addTube(patches, TeapotPart::Handle, kHandle);
  addTube(patches, TeapotPart::Spout, kSpout);
  addRevolution(patches, TeapotPart::LidKnob, kLidKnob);
  addRevolution(patches, TeapotPart::Lid, kLid);
  addRevolution(patches, TeapotPart::Bottom, kBottom);
  return patches;
}

PatchPoint evaluatePatch(const BezierPatch& patch, float u, float v) {
  return {combine(patch, bernstein(u), bernstein(v)), combine(patch, bernsteinDerivative(u), bernstein(v)),
          combine(patch, bernstein(u), bernsteinDerivative(v))};
}

glm::vec2 teapotTextureRows(TeapotPart part) {
  // Heights follow the length of each profile, so that a painted circle stays roughly round on the body.
  switch (part) {
  case TeapotPart::LidKnob:
    return {0.00f, 0.06f};
  case TeapotPart::Lid:
    return {0.06f, 0.22f};
  case TeapotPart::Rim:
    return {0.22f, 0.26f};
  case TeapotPart::BodyUpper:
    return {0.26f, 0.52f};
  case TeapotPart::BodyLower:
    return {0.52f, 0.68f};
  case TeapotPart::Bottom:
    return {0.68f, 0.72f};
  case TeapotPart::Spout:
    return {0.72f, 0.88f};
  case TeapotPart::Handle:
    return {0.88f, 1.00f};
  }
  return {0, 1};
}

Shape teapotShape(int cellsPerPatch) {
  const std::vector<BezierPatch> patches = teapotPatches();
  Shape body;
  for (const BezierPatch& patch : patches) {
    if (!isTube(patch.part)) append(body, patchShape(patch, cellsPerPatch));
  }
  append(body, lidGap(patches, cellsPerPatch));
  Shape teapot = body;
  append(teapot, tubeShell(patches, TeapotPart::Spout, cellsPerPatch));
  append(teapot, tubeShell(patches, TeapotPart::Handle, cellsPerPatch));
  // A crease only where the parts meet at an angle; within and between patches of a part the surface is smooth.
  smoothNormals(teapot, 50.0f);
  return teapot;
}

} // namespace brickfield::scenes
