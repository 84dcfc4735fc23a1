// Each triangle is cut on its own, in parallel; pieces are then added in the order of the triangles.
#include "bakers/mask_cut.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "scene/texture_sampling.h"

namespace brickfield {

namespace {

constexpr double kPieceVoxels = 0.5; // finer than the field can show
constexpr float kBlendCutoff = 0.5f; // as the opaque frame draws it
constexpr int kMostQuarterings = 8;
constexpr std::uint64_t kMostPieces = std::uint64_t{4} << 20;

/// A part of a triangle by the barycentric coordinates of its corners (weights of the second and the third).
using Piece = std::array<glm::vec2, 3>;

const Piece kWhole = {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)};

glm::vec2 centroid(const Piece& piece) { return (piece[0] + piece[1] + piece[2]) / 3.0f; }

std::array<Piece, 4> quarters(const Piece& p) {
  const glm::vec2 ab = 0.5f * (p[0] + p[1]), bc = 0.5f * (p[1] + p[2]), ca = 0.5f * (p[2] + p[0]);
  return {{{p[0], ab, ca}, {ab, p[1], bc}, {ca, bc, p[2]}, {ab, bc, ca}}};
}

double longestEdge(const TriangleSoup& soup, std::uint32_t triangle) {
  const auto [a, b, c] = soup.corners(triangle);
  return std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
}

int quarteringsFor(double edge, double voxelSize) {
  const double halvings = std::ceil(std::log2(edge / (kPieceVoxels * voxelSize)));
  return static_cast<int>(std::clamp<double>(halvings, 0, kMostQuarterings));
}

/// The mask over one triangle.
class MaskedTriangle {
public:
  MaskedTriangle(const Primitive& primitive, const Material& material, std::size_t number,
                 const TextureSampler& sampler)
      : primitive_(primitive), material_(material), number_(number), sampler_(sampler) {}

  /// Appends the kept pieces. Returns true if all of the piece is kept; then it was appended as one.
  bool cut(const Piece& piece, int quarterings, std::vector<Piece>& kept) const {
    if (quarterings == 0) {
      const bool isKept = keeps(centroid(piece));
      if (isKept) kept.push_back(piece);
      return isKept;
    }
    const std::size_t before = kept.size();
    bool isWhole = true;
    for (const Piece& quarter : quarters(piece)) isWhole &= cut(quarter, quarterings - 1, kept);
    if (isWhole) {
      kept.resize(before);
      kept.push_back(piece);
    }
    return isWhole;
  }

private:
  bool keeps(glm::vec2 barycentric) const {
    const MaterialPoint point = materialPointOf(primitive_, number_, barycentric);
    const float cutoff = material_.alphaMode == AlphaMode::Mask ? material_.alphaCutoff : kBlendCutoff;
    return sampler_.sampleBaseColor(material_, point).w >= cutoff;
  }

  const Primitive& primitive_;
  const Material& material_;
  std::size_t number_;
  const TextureSampler& sampler_;
};

void appendPiece(TriangleSoup& soup, std::uint32_t parent, const Piece& piece) {
  const auto [a, b, c] = soup.corners(parent);
  TriangleVertices vertices;
  for (std::size_t k = 0; k < 3; ++k) {
    vertices[k] = static_cast<std::uint32_t>(soup.positions.size());
    const glm::dvec2 weights(piece[k]);
    soup.positions.push_back(a + weights.x * (b - a) + weights.y * (c - a));
  }
  soup.triangles.push_back(vertices);
  soup.primitiveIndices.push_back(soup.primitiveIndices[parent]);
  soup.triangleIndices.push_back(soup.triangleIndices[parent]);
  if (!soup.isBackCovered.empty()) soup.isBackCovered.push_back(soup.isBackCovered[parent]);
  soup.pieceBarycentrics.push_back(piece);
}

/// Blended primitives of which a mask would leave nothing are no cut-outs but thin all over, as glass is: they stay
/// whole.
void keepWholeWhereNothingIsLeft(const BakeInput& input, const TriangleSoup& soup,
                                 const std::vector<std::uint32_t>& masked, std::vector<std::vector<Piece>>& pieces) {
  std::vector<bool> isLeft(input.primitives.size(), false);
  for (std::size_t i = 0; i < masked.size(); ++i)
    if (!pieces[i].empty()) isLeft[soup.primitiveIndices[masked[i]]] = true;
  for (std::size_t i = 0; i < masked.size(); ++i) {
    const std::uint32_t primitive = soup.primitiveIndices[masked[i]];
    if (!isLeft[primitive] && materialOf(*input.scene, *input.primitives[primitive]).alphaMode == AlphaMode::Blend)
      pieces[i] = {kWhole};
  }
}

} // namespace

std::vector<std::uint32_t> cutMaskedSheets(const BakeInput& input, TriangleSoup& soup,
                                           const std::vector<std::uint32_t>& sheets, double voxelSize) {
  const auto primitiveOf = [&](std::uint32_t triangle) -> const Primitive& {
    return *input.primitives[soup.primitiveIndices[triangle]];
  };
  std::vector<std::uint32_t> result, masked;
  for (const std::uint32_t triangle : sheets) {
    const bool isMasked = materialOf(*input.scene, primitiveOf(triangle)).alphaMode != AlphaMode::Opaque;
    (isMasked ? masked : result).push_back(triangle);
  }
  if (masked.empty()) return result;

  int most = kMostQuarterings;
  const auto pieceCount = [&] {
    std::uint64_t count = 0;
    for (const std::uint32_t triangle : masked)
      count += std::uint64_t{1} << 2 * std::min(most, quarteringsFor(longestEdge(soup, triangle), voxelSize));
    return count;
  };
  while (most > 0 && pieceCount() > kMostPieces) --most;

  const TextureSampler sampler(*input.scene);
  std::vector<std::vector<Piece>> pieces(masked.size());
  tbb::parallel_for(std::size_t{0}, masked.size(), [&](std::size_t i) {
    const std::uint32_t t = masked[i];
    const MaskedTriangle triangle(primitiveOf(t), materialOf(*input.scene, primitiveOf(t)), soup.triangleIndices[t],
                                  sampler);
    const int quarterings = std::min(most, quarteringsFor(longestEdge(soup, t), voxelSize));
    triangle.cut(kWhole, quarterings, pieces[i]);
  });
  keepWholeWhereNothingIsLeft(input, soup, masked, pieces);
  for (std::size_t i = 0; i < masked.size(); ++i)
    for (const Piece& piece : pieces[i]) {
      result.push_back(static_cast<std::uint32_t>(soup.triangles.size()));
      appendPiece(soup, masked[i], piece);
    }
  return result;
}

} // namespace brickfield
