// A bake from start to end: gather, split into solids and sheets, lay out, then level by level.
#include "bakers/bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "bakers/bake_memory.h"
#include "bakers/band_bake.h"
#include "bakers/job_pool.h"
#include "bakers/level_baker.h"
#include "bakers/mask_cut.h"
#include "bakers/sheets.h"
#include "bakers/sign_census.h"
#include "bakers/stage_clock.h"
#include "bakers/thin_parts.h"
#include "core/error.h"

namespace brickfield {

namespace {

// A slab half a voxel to each side can fall between two samples and vanish; a sixteenth more cannot, and two steps of
// the 8-bit code are left below zero.
constexpr double kLeastHalfThicknessVoxels = 0.5625;
// Leaves on cards are mostly border, and seen aslant a card is wider by its thickness. Where its middle is half a voxel
// from two samples, they are still inside once rounded: by 0.025 voxels, more than half a step of the 8-bit code,
// 0.016.
constexpr double kPieceShare = 0.525 / kLeastHalfThicknessVoxels;
// A double-sided shell of smaller triangles is taken for the skin of something that is seen from outside. Larger ones
// are walls: what they stand around is a room, and their slabs lie on its outer side. Flat ones stand around nothing,
// but those at the border of a scene are seen from it, whichever way they face.
constexpr double kFineTriangleVoxels = 16;
constexpr std::uint64_t kReportEveryBricks = 32;

void checkSettings(const BakeSettings& settings) {
  const auto refuse = [](const char* name, auto value, const char* reason) {
    throw BadInput(name, fmt::format("{}", value), reason);
  };
  if (settings.resolution < 8 || settings.resolution > kMostResolution)
    refuse("resolution", settings.resolution, "must be from 8 to 1024");
  if (settings.bits != 8 && settings.bits != 16) refuse("bits", settings.bits, "must be 8 or 16");
  if (settings.mips < 1 || settings.mips > 4) refuse("mips", settings.mips, "must be from 1 to 4");
  if (settings.threads < 0) refuse("threads", settings.threads, "must not be negative");
  if (!(settings.thickness >= 0) || !std::isfinite(settings.thickness))
    refuse("thickness", settings.thickness, "must be finite and not negative");
}

/// Counts bricks, reports now and then, and throws when cancelled.
class BakeProgress {
public:
  BakeProgress(const Progress& progress, std::string stage) : progress_(progress), stage_(std::move(stage)) {}

  void begin(std::uint64_t total) {
    total_ = std::max(total_, total);
    add(0);
  }
  void add(std::uint64_t bricks) {
    if (progress_.isCancelled()) throw Cancelled();
    if (bricks == 0 || !progress_.report) return;
    const std::lock_guard lock(mutex_);
    done_ += bricks;
    if (done_ % kReportEveryBricks == 0 || done_ == total_) progress_.report(stage_, done_, total_);
  }

private:
  const Progress& progress_;
  std::string stage_;
  std::mutex mutex_;
  std::uint64_t total_ = 0, done_ = 0;
};

/// Everything that the levels share.
class FieldBaker {
public:
  FieldBaker(const BakeInput& input, const BakeSettings& settings, const Progress& progress)
      : input_(input),
        settings_(settings),
        progress_(progress),
        memory_(input.label, settings.memoryBytes),
        soup_(timed(stats_.stages.gather, [&] { return gatherTriangles(input); })),
        topology_(timed(stats_.stages.gather, [&] { return analyseTopology(soup_); })) {
    soup_.isBackCovered = topology_.isFlatPair;
    memory_.holdTriangles(soup_.triangles.size());
  }

  BakeResult run() {
    split();
    const GridLayout layout = layoutLevels();
    BakeResult result;
    result.field.boundsObject = layout.boundsObject;
    result.field.originObject = layout.originObject;
    result.field.sourceHash = bakeHash(input_, settings_);
    if (thickness_) result.field.thinParts = thinPartsAt(layout.levels, 0);
    std::optional<AttributeBaker> attributes;
    if (settings_.attributes) attributes.emplace(input_, soup_, settings_.thickness <= 0);
    for (std::size_t i = 0; i < layout.levels.size(); ++i) {
      const bool isComplete = i + 1 == layout.levels.size();
      result.field.levels.push_back(bakeOneLevel(layout, i, isComplete, attributes ? &*attributes : nullptr, nullptr));
    }
    fillStats(result.field.levels);
    stats_.bytes = fieldBytes(result.field);
    result.stats = stats_;
    return result;
  }

  BandBake runBand() {
    split();
    const GridLayout layout = layoutLevels();
    BandBake result;
    result.originObject = layout.originObject;
    result.level = bakeOneLevel(layout, 0, false, nullptr, &result.signedVoxels);
    fillStats(std::span(&result.level, 1));
    stats_.bytes = result.level.distances.size() + sizeof(std::uint32_t) * result.level.indirection.size();
    result.stats = stats_;
    result.soup = std::move(soup_);
    return result;
  }

  SignCensus census(const BrickField& field, std::uint64_t mostSamples) {
    split();
    return countSigns(soup_, surfaces_, inside_ ? &*inside_ : nullptr, field, mostSamples);
  }

private:
  double longestSide() const {
    const glm::vec3 extent = soup_.boundsObject.extent();
    return std::max({extent.x, extent.y, extent.z});
  }
  double halfThicknessMetres(double voxelMetres) const {
    return std::max(0.5 * static_cast<double>(settings_.thickness), kLeastHalfThicknessVoxels * voxelMetres);
  }

  void split() {
    SolidsAndSheets split;
    std::vector<std::uint32_t> all(soup_.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    if (settings_.sign == SignMethod::TwoSided) {
      split.sheets = std::move(all);
    } else if (settings_.sign == SignMethod::Auto) {
      const double voxelMetres = longestSide() / settings_.resolution;
      SheetRequest request;
      request.voxelSize = voxelMetres * soup_.unitsPerMetre;
      request.halfThickness = halfThicknessMetres(voxelMetres) * soup_.unitsPerMetre;
      request.isCutOut.resize(soup_.triangles.size());
      request.isDoubleSided.resize(soup_.triangles.size());
      for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
        const Material& material = materialOf(*input_.scene, *input_.primitives[soup_.primitiveIndices[t]]);
        request.isCutOut[t] = material.alphaMode != AlphaMode::Opaque;
        request.isDoubleSided[t] = material.doubleSided;
      }
      split = timed(stats_.stages.gather, [&] { return findSheets(soup_, topology_, request); });
    } else {
      split.solid = std::move(all);
    }
    sheetCount_ = split.sheets.size();
    split.sheets =
        cutMaskedSheets(input_, soup_, split.sheets, longestSide() / settings_.resolution * soup_.unitsPerMetre);
    if (split.sheets.empty() && split.solid.empty())
      throw BadInput(input_.label, "", "is cut away entirely by its alpha mask");
    if (!split.sheets.empty()) {
      sheets_ = split.sheets;
      const StageClock clock(stats_.stages.hierarchy);
      sheetHierarchy_ = std::make_unique<MeshHierarchy>(soup_, split.sheets);
      surfaces_.sheets.emplace(*sheetHierarchy_);
      surfaces_.slabs.emplace(soup_, *sheetHierarchy_, slabRequest());
    }
    if (split.solid.empty()) return;
    timed(stats_.stages.hierarchy, [&] {
      solidHierarchy_ =
          split.solidHierarchy ? std::move(split.solidHierarchy) : std::make_unique<MeshHierarchy>(soup_, split.solid);
      surfaces_.solid.emplace(*solidHierarchy_);
    });
    const StageClock clock(stats_.stages.sign);
    inside_.emplace(soup_, topology_, *solidHierarchy_, settings_.sign, input_.label, std::move(split.solidWinding));
    thickness_.emplace(soup_, topology_, *surfaces_.solid, *inside_);
  }

  /// Slabs as thin as can be shown lie behind their fronts where those can be told: a thickness that was asked for is
  /// shared by both sides, and so is that of cards and of meshes whose neighbours disagree on the front.
  SlabRequest slabRequest() const {
    SlabRequest request;
    const double voxelMetres = longestSide() / settings_.resolution;
    request.halfThickness = halfThicknessMetres(voxelMetres) * soup_.unitsPerMetre;
    request.mayLieBehind.resize(soup_.triangles.size());
    request.isDoubleSided.resize(soup_.triangles.size());
    request.isTurned.resize(soup_.triangles.size());
    if (settings_.thickness <= 0) request.pieceShare = kPieceShare;
    if (settings_.sign != SignMethod::Auto || settings_.thickness > 0) return request;
    const double fineArea = std::pow(kFineTriangleVoxels * voxelMetres * soup_.unitsPerMetre, 2.0);
    const std::vector<ComponentShape> shapes = componentShapes();
    for (std::uint32_t t = 0; t < soup_.firstPiece(); ++t) {
      const Material& material = materialOf(*input_.scene, *input_.primitives[soup_.primitiveIndices[t]]);
      const ComponentShape& shape = shapes[topology_.componentOf[t]];
      const bool isWall = material.doubleSided && shape.area > fineArea * static_cast<double>(shape.triangleCount);
      request.isDoubleSided[t] = material.doubleSided;
      const bool isSeen = material.doubleSided && shape.isFlat() && input_.seenFromObject != glm::vec3(0);
      request.isTurned[t] = isSeen ? glm::dot(shape.areaVector, glm::dvec3(input_.seenFromObject)) < 0
                                   : isWall && shape.outwardness() > 0;
      request.mayLieBehind[t] = !topology_.isFlatPair[t] && !topology_.isTwisted[t] &&
                                material.alphaMode == AlphaMode::Opaque && (isSeen || !(isWall && shape.isFlat()));
    }
    return request;
  }

  /// Sums over the triangles of a component, in soup space.
  struct ComponentShape {
    std::size_t triangleCount = 0;
    double area = 0, flux = 0;
    glm::dvec3 areaVector{0.0}, areaCentroid{0.0};

    bool isFlat() const { return glm::length(areaVector) > kFlatShare * area; }
    /// Volume of the cones to the centroid, three times: positive where the fronts face away from it.
    double outwardness() const { return flux - glm::dot(areaVector, areaCentroid / area); }
  };
  /// By MeshTopology::componentOf.
  std::vector<ComponentShape> componentShapes() const {
    std::vector<ComponentShape> shapes(soup_.triangles.size());
    for (std::uint32_t t = 0; t < soup_.firstPiece(); ++t) {
      ComponentShape& shape = shapes[topology_.componentOf[t]];
      const auto [a, b, c] = soup_.corners(t);
      const glm::dvec3 areaVector = 0.5 * glm::cross(b - a, c - a), centroid = (a + b + c) / 3.0;
      ++shape.triangleCount;
      shape.area += glm::length(areaVector);
      shape.flux += glm::dot(areaVector, centroid);
      shape.areaVector += areaVector;
      shape.areaCentroid += glm::length(areaVector) * centroid;
    }
    return shapes;
  }

  /// The surface's bounds in object space with the slabs of a level of such voxels.
  Box withSlabs(double voxelMetres) const {
    glm::dvec3 low(0.0), high(0.0); // of soup space: its zero is the middle of the mesh
    surfaces_.slabs->growBounds(sheets_, halfThicknessMetres(voxelMetres) * soup_.unitsPerMetre, low, high);
    Box box = soup_.boundsObject;
    box.extend(Box{glm::vec3(low / soup_.unitsPerMetre + soup_.centerObject),
                   glm::vec3(high / soup_.unitsPerMetre + soup_.centerObject)});
    return box;
  }

  GridLayout layoutLevels() const {
    Box surface = soup_.boundsObject;
    if (surfaces_.sheets) {
      // The slab of the coarsest level is the thickest; it must not be cut by the bounds. The voxel grows with the box,
      // by less than a fifth, which the voxel around the box makes up for.
      int coarsest = settings_.mips - 1;
      while (coarsest > 0 && (kBrickCells << coarsest) > settings_.resolution + 2) --coarsest;
      surface = withSlabs(std::ldexp(longestSide() / settings_.resolution, coarsest));
    }
    try {
      return layoutGrid(surface, settings_.resolution, settings_.mips);
    } catch (const BadInput& error) {
      throw BadInput(input_.label, "", error.what());
    }
  }

  const ThinParts& thinPartsAt(std::span<const LevelLayout> levels, std::size_t index) {
    const StageClock clock(stats_.stages.sign);
    thinParts_.resize(levels.size());
    if (!thinParts_[index])
      thinParts_[index] =
          findThinParts(*thickness_, levels[index].voxelSizeObject * soup_.unitsPerMetre, settings_.resolution);
    return *thinParts_[index];
  }

  BrickLevel bakeOneLevel(const GridLayout& layout, std::size_t index, bool isComplete,
                          const AttributeBaker* attributes, LargeVector<float>* signedVoxels) {
    BakeProgress progress(progress_,
                          fmt::format("bake {}, level {} of {}", input_.label, index + 1, layout.levels.size()));
    LevelBakeRequest request;
    request.layout = layout.levels[index];
    request.format = distanceFormatOfBits(settings_.bits);
    request.inside = inside_ ? &*inside_ : nullptr;
    request.attributes = attributes;
    request.stats = &stats_;
    request.signedVoxels = signedVoxels;
    const double voxelMetres = request.layout.voxelSizeObject;
    SamplingRequest& sampling = request.sampling;
    sampling.soup = &soup_;
    sampling.surfaces = &surfaces_;
    sampling.grid = {soup_.soupFromObject(layout.originObject), voxelMetres * soup_.unitsPerMetre,
                     request.layout.brickCounts};
    sampling.halfThickness = halfThicknessMetres(voxelMetres) * soup_.unitsPerMetre;
    if (settings_.sign == SignMethod::Auto && thickness_ && thinPartsAt(layout.levels, index).resolution > 0) {
      request.thickness = &*thickness_;
      sampling.solidGrowthVoxels = kMostGrowthVoxels;
    }
    sampling.keepsTriangles = attributes || request.thickness;
    sampling.isComplete = isComplete;
    sampling.admit = [&](std::size_t bricks) {
      admitMemory(bricks, layout.levels[index], index, request);
      progress.begin(bricks);
    };
    sampling.done = [&](std::size_t bricks) { progress.add(bricks); };
    return bakeLevel(request);
  }

  void admitMemory(std::size_t bricks, const LevelLayout& layout, std::size_t index, const LevelBakeRequest& request) {
    BakeMemory::Level level;
    level.index = index, level.bricks = bricks;
    level.cells = static_cast<std::size_t>(layout.brickCounts.x) * static_cast<std::size_t>(layout.brickCounts.y) *
                  static_cast<std::size_t>(layout.brickCounts.z);
    level.surfaces = (surfaces_.solid ? 1 : 0) + (surfaces_.sheets ? 1 : 0);
    level.hasAttributes = request.attributes != nullptr;
    level.keepsTriangles = request.sampling.keepsTriangles, level.growsSolids = request.thickness != nullptr;
    memory_.admit(level);
  }

  void fillStats(std::span<const BrickLevel> levels) {
    stats_.triangles = soup_.firstPiece();
    stats_.degenerateTriangles = soup_.degenerateCount;
    stats_.openEdges = topology_.openEdges;
    stats_.nonManifoldEdges = topology_.nonManifoldEdges;
    stats_.sheetTriangles = sheetCount_;
    const bool isForced = settings_.sign == SignMethod::Parity || settings_.sign == SignMethod::Pseudonormal;
    stats_.sign = !inside_                               ? "two-sided"
                  : settings_.sign == SignMethod::Parity ? "parity"
                  : isForced                             ? "pseudonormal"
                  : inside_->isConstantBetweenSurfaces() ? "winding of closed surfaces"
                                                         : "winding of open surfaces";
    if (inside_ && surfaces_.sheets) stats_.sign += " and sheets";
    for (const BrickLevel& level : levels) stats_.bricks += level.brickCount();
    for (const auto* hierarchy : {&solidHierarchy_, &sheetHierarchy_})
      if (*hierarchy) stats_.hierarchyBytes += (*hierarchy)->bytes();
    if (inside_) stats_.hierarchyBytes += inside_->bytes();
  }

  const BakeInput& input_;
  const BakeSettings& settings_;
  const Progress& progress_;
  BakeStats stats_;
  BakeMemory memory_;
  TriangleSoup soup_;
  MeshTopology topology_;
  std::unique_ptr<MeshHierarchy> solidHierarchy_, sheetHierarchy_;
  BakeSurfaces surfaces_;
  std::optional<InsideTest> inside_;
  std::optional<SolidThickness> thickness_;
  std::vector<std::optional<ThinParts>> thinParts_; ///< a level, where they were asked for
  std::vector<std::uint32_t> sheets_;
  std::size_t sheetCount_ = 0;
};

} // namespace

namespace {

/// Runs a bake on as many threads as asked for. work(FieldBaker&) returns what has stats.
template <typename Work>
auto bakeOnThreads(const BakeInput& input, const BakeSettings& settings, const Progress& progress, const Work& work) {
  checkSettings(settings);
  const auto start = std::chrono::steady_clock::now();
  tbb::task_arena arena(threadsFor(settings.threads));
  auto result = arena.execute([&] {
    FieldBaker baker(input, settings, progress);
    return work(baker);
  });
  result.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

} // namespace

BakeResult bakeField(const BakeInput& input, const BakeSettings& settings, const Progress& progress) {
  return bakeOnThreads(input, settings, progress, [](FieldBaker& baker) { return baker.run(); });
}

BandBake bakeBand(const BakeInput& input, const BakeSettings& settings, const Progress& progress) {
  return bakeOnThreads(input, settings, progress, [](FieldBaker& baker) { return baker.runBand(); });
}

SignCensus takeSignCensus(const BakeInput& input, const BakeSettings& settings, const BrickField& field,
                          std::uint64_t mostSamples) {
  return FieldBaker(input, settings, {}).census(field, mostSamples);
}

} // namespace brickfield
