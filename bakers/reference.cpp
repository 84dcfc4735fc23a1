// The reference image: passes of ever more samples over all tiles, tiles over all cores, each pixel on its own, so that
// threads change nothing.
#include "bakers/reference.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <fmt/format.h>

#include "bakers/job_pool.h"
#include "bakers/reference_geometry.h"
#include "bakers/reference_samples.h"
#include "bakers/reference_shading.h"
#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kTilePixels = 16;
constexpr int kMostPassSamples = 64; // of a pixel in one pass: a look at the cancel flag lies between two passes
constexpr std::size_t kMostShadowLayers = 32; // files of layers hold 64 parts

RayBundle bundleOf(const View& view, glm::vec2 pixel, float step) {
  return {primaryRay(view, pixel), primaryRay(view, pixel + glm::vec2(step, 0.0f)),
          primaryRay(view, pixel + glm::vec2(0.0f, step))};
}

FrameLayers emptyLayers(glm::uvec2 size) {
  const std::size_t count = std::size_t{size.x} * size.y;
  FrameLayers layers;
  layers.size = size;
  layers.color.assign(count, glm::vec3(0.0f));
  layers.depth.assign(count, std::numeric_limits<float>::infinity());
  layers.normal.assign(count, glm::vec3(0.0f));
  layers.normalSurface.assign(count, glm::vec3(0.0f));
  layers.albedo.assign(count, glm::vec3(0.0f));
  layers.id.assign(count, -1);
  layers.kind.assign(count, SurfaceKind::None);
  layers.steps.assign(count, 0.0f); // nothing here is stepped through; made, so that the renderer's layers are matched
  return layers;
}

class Tracer {
public:
  Tracer(const ReferenceRequest& request, const Progress& progress)
      : request_(request),
        progress_(progress),
        sampler_(*request.scene),
        geometry_(*request.scene, *request.pose, request.fields, sampler_, progress),
        shading_(request, geometry_, sampler_),
        layers_(emptyLayers(request.view->sizePixels)),
        samples_(std::max(request.samples, 1)),
        tileCounts_((layers_.size + kTilePixels - 1u) / kTilePixels) {
    const std::size_t pixels = layers_.depth.size();
    if (request.shadowLayers && request.shadows)
      layers_.shadow.assign(std::min(request.lighting->lights.size(), kMostShadowLayers),
                            std::vector<float>(pixels, 1.0f));
    if (request.ambientOcclusionMetres) layers_.ambientOcclusion.assign(pixels, 1.0f);
    // The rays of the layers are a pass of their own, unless the only sample of the picture is that same ray.
    isLayerPassShared_ = samples_ == 1 && !request.layersAlone;
    total_ =
        tileCount() * (request.layersAlone ? 1 : static_cast<std::size_t>(samples_ + (isLayerPassShared_ ? 0 : 1)));
  }

  FrameLayers run() {
    runPass("reference", 1, [this](glm::uvec2 pixel) { traceLayers(pixel); });
    if (request_.layersAlone) {
      layers_.color.clear();
      return std::move(layers_);
    }
    int passSamples = 1;
    for (int begin = isLayerPassShared_ ? samples_ : 0; begin < samples_; begin += passSamples) {
      passSamples = std::min({std::max(begin, 1), kMostPassSamples, samples_ - begin});
      const std::string stage = fmt::format("reference, {} of {} samples", begin, samples_);
      runPass(stage, passSamples, [=, this](glm::uvec2 pixel) { addSamples(pixel, begin, begin + passSamples); });
    }
    for (glm::vec3& color : layers_.color) color /= static_cast<float>(samples_);
    return std::move(layers_);
  }

private:
  std::size_t tileCount() const { return std::size_t{tileCounts_.x} * tileCounts_.y; }
  std::size_t indexOf(glm::uvec2 pixel) const { return std::size_t{pixel.y} * layers_.size.x + pixel.x; }

  /// weight  samples a pixel, for the progress
  template <typename TracePixel>
  void runPass(const std::string& stage, int weight, const TracePixel& tracePixel) {
    tbb::parallel_for(std::size_t{0}, tileCount(), [&](std::size_t tile) {
      const glm::uvec2 place(tile % tileCounts_.x, tile / tileCounts_.x);
      const glm::uvec2 begin = place * kTilePixels, end = glm::min(begin + kTilePixels, layers_.size);
      for (std::uint32_t y = begin.y; y < end.y; ++y)
        for (std::uint32_t x = begin.x; x < end.x && !progress_.isCancelled(); ++x) tracePixel(glm::uvec2(x, y));
      if (!progress_.isCancelled()) report(stage, done_ += static_cast<std::size_t>(weight));
    });
    if (progress_.isCancelled()) throw Cancelled();
  }

  /// The ray through the pixel's centre, which sees what a rasterizer's pixel sees.
  void traceLayers(glm::uvec2 pixel) {
    const PixelSamples samples(pixel, request_.seed, samples_);
    const RayBundle rays = bundleOf(*request_.view, glm::vec2(pixel) + 0.5f, 1.0f);
    const std::optional<SurfaceHit> hit = geometry_.trace(rays);
    if (hit) fillLayers(indexOf(pixel), *hit, samples);
    if (isLayerPassShared_) layers_.color[indexOf(pixel)] = shading_.radiance(rays, hit, samples, 0);
  }

  void fillLayers(std::size_t index, const SurfaceHit& hit, const PixelSamples& samples) {
    const MaterialSample material = shading_.materialOf(hit);
    layers_.depth[index] = hit.distance;
    layers_.normal[index] = shadingNormal(hit, material);
    layers_.normalSurface[index] = hit.isBackFace ? -hit.normalVertex : hit.normalVertex;
    layers_.albedo[index] = glm::vec3(material.baseColor);
    layers_.id[index] = hit.node;
    const bool isSdf = hit.fieldMaterial || (request_.isSdf && request_.isSdf(hit.node));
    layers_.kind[index] = isSdf ? SurfaceKind::Sdf : SurfaceKind::Mesh;
    for (std::uint32_t light = 0; light < layers_.shadow.size() && !progress_.isCancelled(); ++light)
      layers_.shadow[light][index] = shading_.visibleShare(hit, light, samples);
    if (!layers_.ambientOcclusion.empty()) layers_.ambientOcclusion[index] = shading_.openShare(hit, samples);
  }

  void addSamples(glm::uvec2 pixel, int begin, int end) {
    const PixelSamples samples(pixel, request_.seed, samples_);
    const float step = 1.0f / std::sqrt(static_cast<float>(samples_)); // the samples share the pixel
    glm::dvec3 sum(0.0);
    for (int sample = begin; sample < end; ++sample) {
      const glm::vec2 place = glm::vec2(pixel) + samples.point(sample, SamplePurpose::Pixel);
      const RayBundle rays = bundleOf(*request_.view, place, step);
      sum += shading_.radiance(rays, geometry_.trace(rays), samples, sample);
    }
    layers_.color[indexOf(pixel)] += glm::vec3(sum);
  }

  /// Whoever finds another thread reporting does not wait for it; the last tile always reports.
  void report(const std::string& stage, std::size_t done) {
    if (!progress_.report) return;
    std::unique_lock lock(reportMutex_, std::defer_lock);
    if (done == total_)
      lock.lock();
    else if (!lock.try_lock())
      return;
    mostReported_ = std::max(mostReported_, done);
    progress_.report(stage, mostReported_, total_);
  }

  const ReferenceRequest& request_;
  const Progress& progress_;
  TextureSampler sampler_;
  ReferenceGeometry geometry_;
  ReferenceShading shading_;
  FrameLayers layers_;
  int samples_;
  glm::uvec2 tileCounts_;
  bool isLayerPassShared_ = false;
  std::size_t total_ = 0;
  std::atomic<std::size_t> done_{0};
  std::mutex reportMutex_;
  std::size_t mostReported_ = 0;
};

} // namespace

FrameLayers traceReference(const ReferenceRequest& request, const Progress& progress) {
  const glm::vec3 eye = glm::abs(request.view->eyeWorld);
  if (constexpr float kFarthestEye = 1e12f; !(std::max({eye.x, eye.y, eye.z}) < kFarthestEye))
    throw BadInput("camera", "eye", "the reference needs it within 1e12 metres of the origin");
  tbb::task_arena arena(threadsFor(request.threads));
  return arena.execute([&] { return Tracer(request, progress).run(); });
}

} // namespace brickfield
