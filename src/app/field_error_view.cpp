// The same points as the shader of the field views, the same reading by its twin.
#include "app/field_error_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "field/field_volume.h"
#ifdef BRICKFIELD_BAKERS
#include "bakers/field_truth.h"
#endif

namespace brickfield {

#ifdef BRICKFIELD_BAKERS

namespace {

constexpr double kRedTexels = 0.5;
// Nearer to a surface than this, a wrong side is one of rounding: half floats and interpolation.
constexpr double kSidelessTexels = 0.1;

// Twin of heat in shaders/lib/debug_colors.glsl.
glm::vec3 heat(double unit) {
  const auto x = static_cast<float>(std::clamp(unit, 0.0, 1.0));
  return glm::clamp(glm::vec3(2.5f * x - 0.75f, x < 0.75f ? 1.8f * x : 4.05f - 3.6f * x, 0.35f + 0.5f * x - 2 * x * x),
                    0.0f, 1.0f);
}

// The meshes together, whose buried surfaces count, and each SDF object alone, of which the least value counts.
std::vector<FieldOracle> oraclesOf(const Scene& scene, const Pose& pose, const std::vector<int>& fieldOfNode) {
  std::vector<FieldOracle> oracles;
  oracles.emplace_back(scene, pose, fieldOfNode);
  for (const PosedInstance& instance : pose.instances) {
    if (fieldOfNode[static_cast<std::size_t>(instance.node)] < 0) continue;
    Pose alone = pose;
    alone.instances = {instance};
    oracles.emplace_back(scene, alone);
  }
  return oracles;
}

// texels  as found
glm::vec3 colorOf(double texels, double expected) {
  if ((texels < 0) != (expected < 0) && std::min(std::abs(texels), std::abs(expected)) > kSidelessTexels)
    return {1, 0, 1};
  // A value may stand for all that is farther, out to the side it is on.
  const bool mayBeCut = std::abs(expected) > 4;
  const double tooMuch = std::abs(texels) - std::abs(expected);
  return heat((mayBeCut ? std::max(tooMuch, 0.0) : std::abs(texels - expected)) / kRedTexels);
}

} // namespace

const DebugView* fieldErrorView() {
  static const DebugView view{
      "field-error",
      "the same plane: error against exact distances, blue none, red 0.5 texels, magenta the wrong side",
      shared::DEBUG_VIEW_FIELD,
      static_cast<float>(kRedTexels),
      true,
      true,
      false};
  return &view;
}

RgbImage fieldErrorPicture(const FieldVolumes& field, const FieldPicture& plane, glm::uvec2 size, const Scene& scene,
                           const Pose& pose, const std::vector<int>& fieldOfNode) {
  std::span<const FieldVolume> shown(field.cascades);
  if (plane.cascade >= 0) shown = shown.subspan(static_cast<std::size_t>(plane.cascade), 1);
  std::vector<FieldSample> samples;
  std::vector<glm::dvec3> world;
  std::vector<double> texelMetres;
  for (std::uint32_t y = 0; y < size.y; ++y)
    for (std::uint32_t x = 0; x < size.x; ++x) {
      const double right = x + 0.5 - 0.5 * size.x, up = 0.5 * size.y - (y + 0.5);
      const glm::dvec3 anchored = glm::dvec3(plane.centerAnchored) + right * glm::dvec3(plane.rightAnchored) +
                                  up * glm::dvec3(plane.upAnchored);
      const FieldSample& sample = samples.emplace_back(sampleField(shown, anchored));
      world.push_back(anchored + field.anchorWorld);
      texelMetres.push_back(sample.cascade < 0 ? 0 : shown[static_cast<std::size_t>(sample.cascade)].texelSize);
    }
  std::vector<double> expected(samples.size(), std::numeric_limits<double>::infinity()); // metres
  for (const FieldOracle& oracle : oraclesOf(scene, pose, fieldOfNode)) {
    const std::vector<FieldTruth> truths = oracle.at(world, texelMetres);
    for (std::size_t i = 0; i < truths.size(); ++i)
      expected[i] = std::min(expected[i], truths[i].unionDistance(0.5 * texelMetres[i]));
  }
  RgbImage image{size, {}};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const FieldSample& sample = samples[i];
    if (sample.cascade < 0) {
      image.pixels.emplace_back(0.12f);
      continue;
    }
    image.pixels.push_back(colorOf(sample.distanceWorld / texelMetres[i], expected[i] / texelMetres[i]));
  }
  return image;
}

#else

const DebugView* fieldErrorView() { return nullptr; }

RgbImage fieldErrorPicture(const FieldVolumes&, const FieldPicture&, glm::uvec2, const Scene&, const Pose&,
                           const std::vector<int>&) {
  throw BadInput("--view", "field-error", "is not in a build without bakers");
}

#endif

} // namespace brickfield
