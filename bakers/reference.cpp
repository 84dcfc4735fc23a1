// The reference image: tiles of pixels over all cores, each pixel on its own, so that threads change nothing.
#include "bakers/reference.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "bakers/reference_geometry.h"
#include "bakers/reference_shading.h"
#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kTilePixels = 16;

/// SplitMix64's finalizer (Steele et al. 2014): well mixed bits of a counter.
std::uint64_t mixBits(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

/// Where in its pixel a sample goes: the centre first, then the plastic-number sequence (Roberts 2018), evenly spread
/// for any count and shifted by a random amount of the pixel's own.
glm::vec2 sampleOffset(int sample, glm::uvec2 pixel, std::uint64_t seed) {
  if (sample == 0) return glm::vec2(0.5f);
  constexpr glm::dvec2 kStep(0.7548776662466927, 0.5698402909980532); // 1/p, 1/p² with p³ = p + 1
  const std::uint64_t bits = mixBits(mixBits(seed) ^ (std::uint64_t{pixel.y} << 32 | pixel.x));
  const glm::dvec2 shift(static_cast<double>(bits >> 32), static_cast<double>(bits & 0xffffffffu));
  return glm::vec2(glm::fract(shift / 4294967296.0 + static_cast<double>(sample) * kStep));
}

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
        geometry_(*request.scene, *request.pose, sampler_, progress),
        shading_(*request.lighting, geometry_, request.shadows),
        layers_(emptyLayers(request.view->sizePixels)) {}

  FrameLayers run() {
    const glm::uvec2 tiles((layers_.size + kTilePixels - 1u) / kTilePixels);
    const std::size_t tileCount = std::size_t{tiles.x} * tiles.y;
    std::atomic<std::size_t> doneCount{0};
    tbb::parallel_for(std::size_t{0}, tileCount, [&](std::size_t tile) {
      if (progress_.isCancelled()) return;
      traceTile({static_cast<std::uint32_t>(tile % tiles.x), static_cast<std::uint32_t>(tile / tiles.x)});
      report(++doneCount, tileCount);
    });
    if (progress_.isCancelled()) throw Cancelled();
    return std::move(layers_);
  }

private:
  void traceTile(glm::uvec2 tile) {
    const glm::uvec2 begin = tile * kTilePixels, end = glm::min(begin + kTilePixels, layers_.size);
    for (std::uint32_t y = begin.y; y < end.y; ++y)
      for (std::uint32_t x = begin.x; x < end.x && !progress_.isCancelled(); ++x) tracePixel({x, y});
  }

  void tracePixel(glm::uvec2 pixel) {
    const std::size_t index = std::size_t{pixel.y} * layers_.size.x + pixel.x;
    const int samples = std::max(request_.samples, 1);
    glm::vec3 sum(0.0f);
    for (int sample = 0; sample < samples; ++sample) {
      // The first sample alone makes the layers and sees what a rasterizer's pixel sees; the others share the pixel.
      const float step = sample == 0 ? 1.0f : 1.0f / std::sqrt(static_cast<float>(samples));
      const glm::vec2 place = glm::vec2(pixel) + sampleOffset(sample, pixel, request_.seed);
      sum += traceSample(bundleOf(*request_.view, place, step), sample == 0 ? &index : nullptr);
    }
    layers_.color[index] = sum / static_cast<float>(samples);
  }

  /// layerIndex   where the layers of this sample go, if anywhere
  glm::vec3 traceSample(const RayBundle& rays, const std::size_t* layerIndex) {
    const glm::vec3 direction = rays.center.directionWorld;
    const std::optional<SurfaceHit> hit = geometry_.trace(rays);
    if (!hit) return shading_.sky(direction);
    const MaterialSample material = sampler_.sampleMaterial(*hit->material, hit->materialPoint);
    const glm::vec3 normal = shadingNormal(*hit, material);
    if (layerIndex) {
      layers_.depth[*layerIndex] = hit->distance;
      layers_.normal[*layerIndex] = normal;
      layers_.normalSurface[*layerIndex] = hit->isBackFace ? -hit->normalVertex : hit->normalVertex;
      layers_.albedo[*layerIndex] = glm::vec3(material.baseColor);
      layers_.id[*layerIndex] = hit->node;
      layers_.kind[*layerIndex] = request_.isSdf && request_.isSdf(hit->node) ? SurfaceKind::Sdf : SurfaceKind::Mesh;
    }
    return shading_.shade(*hit, material, normal, -direction);
  }

  /// Whoever finds another thread reporting does not wait for it; the last tile always reports.
  void report(std::size_t done, std::size_t total) {
    if (!progress_.report) return;
    std::unique_lock lock(reportMutex_, std::defer_lock);
    if (done == total)
      lock.lock();
    else if (!lock.try_lock())
      return;
    mostReported_ = std::max(mostReported_, done);
    progress_.report("reference", mostReported_, total);
  }

  const ReferenceRequest& request_;
  const Progress& progress_;
  TextureSampler sampler_;
  ReferenceGeometry geometry_;
  ReferenceShading shading_;
  FrameLayers layers_;
  std::mutex reportMutex_;
  std::size_t mostReported_ = 0;
};

} // namespace

FrameLayers traceReference(const ReferenceRequest& request, const Progress& progress) {
  const glm::vec3 eye = glm::abs(request.view->eyeWorld);
  if (constexpr float kFarthestEye = 1e12f; !(std::max({eye.x, eye.y, eye.z}) < kFarthestEye))
    throw BadInput("camera", "eye", "the reference needs it within 1e12 metres of the origin");
  tbb::task_arena arena(request.threads > 0 ? request.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return Tracer(request, progress).run(); });
}

} // namespace brickfield
