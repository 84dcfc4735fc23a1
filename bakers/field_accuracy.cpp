// Every texel is judged by itself on some thread; the judgements are summed up in order, so the figures are the same on
// any number of threads.
#include "bakers/field_accuracy.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

namespace brickfield {

namespace {

constexpr double kNearTexels = 4;
constexpr double kSidelessTexels = 1e-3; // nearer to a surface than this, sides are those of rounding

// Of two surfaces about equally near a field may take the other one. Near surfaces by its error; beyond, it may lie
// between texels twice as large, whose nearest surfaces differ by their diagonal.
constexpr double kTieTexels = 0.05, kFarTieTexels = 3.5;
constexpr double kThickTexels = 1; // thinner parts count as so thick
constexpr double kBehindTexels = 0.01;

enum class Judgement : std::uint8_t { Outside, Near, Far, Overlap, WrongSign };

struct JudgedTexel {
  Judgement judgement = Judgement::Outside;
  bool hasSign = false;
  double error = 0; // value less truth
  double truth = 0;
  double toSurface = 0;
};

glm::dvec3 centerAnchored(const FieldVolume& volume, std::size_t texel) {
  const auto width = static_cast<std::size_t>(volume.extent.x), height = static_cast<std::size_t>(volume.extent.y);
  const glm::ivec3 at(texel % width, texel / width % height, texel / (width * height));
  return (glm::dvec3(volume.firstTexel + at) + 0.5) * volume.texelSize;
}

JudgedTexel judge(const FieldVolume& volume, float value, glm::dvec3 pointWorld, const FieldOracle& oracle,
                  SheetMeaning sheets) {
  const double h = volume.texelSize, range = volume.rangeTexels;
  const FieldTruth truth = oracle.at(pointWorld, sheets == SheetMeaning::Thick ? h : 0);
  const bool isSideless = sheets == SheetMeaning::Unsigned && !truth.onClosedComponent();
  JudgedTexel texel;
  texel.toSurface = truth.unsignedDistance() / h;
  // Where thin parts are thicker than they are, their surface lies farther out.
  const double toThickened = truth.thinning > 0 ? std::abs(truth.closedDistance - truth.thinning) / h : texel.toSurface;
  texel.hasSign = truth.onClosedComponent() && std::min(texel.toSurface, toThickened) > kSidelessTexels;
  if (truth.insideClosed && !truth.onClosedComponent()) {
    texel.judgement = Judgement::Overlap; // a sheet is nearest, within the solid that is
    return texel;
  }
  if (texel.hasSign && (value < 0) != (truth.insideClosed || truth.closedDistance < truth.thinning)) {
    const double tie = texel.toSurface <= kNearTexels ? kTieTexels : kFarTieTexels;
    const double reach = (std::max(texel.toSurface, std::abs(double{value})) + tie) * h;
    const bool isBuried = truth.openDistance <= reach || oracle.seesBuriedSurface(pointWorld, reach, kBehindTexels * h);
    texel.judgement = truth.insideAny && isBuried ? Judgement::Overlap : Judgement::WrongSign;
    return texel;
  }
  const double halfThickness = sheets == SheetMeaning::Thick ? 0.5 * h : 0;
  texel.truth = std::clamp((isSideless ? truth.openDistance : truth.unionDistance(halfThickness)) / h, -range, range);
  texel.error = (isSideless ? std::abs(value) : value) - texel.truth;
  texel.judgement = texel.toSurface <= kNearTexels ? Judgement::Near : Judgement::Far;
  // Within a solid that another reaches into nothing near tells how thick it is.
  if (sheets == SheetMeaning::Thick && truth.insideAny && texel.toSurface <= kThickTexels &&
      std::abs(texel.error) > kTieTexels && oracle.seesBuriedSurface(pointWorld, 2 * h, kBehindTexels * h))
    texel.judgement = Judgement::Overlap;
  return texel;
}

FieldAccuracy summedUp(const std::vector<JudgedTexel>& texels) {
  FieldAccuracy sum;
  std::vector<double> near;
  double squares = 0, far = 0;
  std::size_t farTexels = 0, wrong = 0;
  for (const JudgedTexel& texel : texels) {
    sum.signedTexels += texel.hasSign;
    if (texel.judgement == Judgement::Overlap) ++sum.overlaps;
    if (texel.judgement == Judgement::WrongSign) {
      ++wrong;
      sum.farthestWrongSign = std::max(sum.farthestWrongSign, texel.toSurface);
    }
    if (texel.judgement == Judgement::Near) {
      near.push_back(std::abs(texel.error));
      squares += texel.error * texel.error;
    }
    if (texel.judgement == Judgement::Far) {
      ++farTexels;
      far += std::abs(texel.error);
      if (texel.truth > 0) sum.farAbove = std::max(sum.farAbove, texel.error); // inside, no ray goes
      sum.farBelow = std::max(sum.farBelow, -texel.error);
    }
  }
  std::sort(near.begin(), near.end());
  sum.texels = near.size();
  if (!near.empty()) {
    sum.rms = std::sqrt(squares / static_cast<double>(near.size()));
    sum.p999 = near[static_cast<std::size_t>(0.999 * static_cast<double>(near.size() - 1))];
    sum.worst = near.back();
  }
  sum.farMean = farTexels ? far / static_cast<double>(farTexels) : 0;
  sum.wrongSigns = sum.signedTexels ? static_cast<double>(wrong) / static_cast<double>(sum.signedTexels) : 0;
  return sum;
}

} // namespace

FieldAccuracy measureAccuracy(const FieldVolume& volume, glm::dvec3 anchorWorld, const FieldOracle& oracle,
                              SheetMeaning sheets, std::size_t mostTexels, const Box& boundsWorld) {
  const std::size_t all = volume.distances.size();
  const std::size_t stride = all <= mostTexels ? 1 : (all + mostTexels - 1) / mostTexels | 1; // odd: no columns
  std::vector<JudgedTexel> texels((all + stride - 1) / stride);
  tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t i) {
    const glm::dvec3 pointWorld = centerAnchored(volume, i * stride) + anchorWorld;
    if (!boundsWorld.contains(glm::vec3(pointWorld))) return;
    texels[i] = judge(volume, volume.distances[i * stride], pointWorld, oracle, sheets);
  });
  return summedUp(texels);
}

} // namespace brickfield
