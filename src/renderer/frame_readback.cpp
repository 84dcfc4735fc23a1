// Decodes what the G-buffer packs.
#include "renderer/frame_readback.h"

#include <algorithm>

#include "shared/frame_params.h"

namespace brickfield {

namespace {

// Ray parameter of a stored depth, as rayParameterOfDepth of shaders/lib/frame.glsl.
float rayParameterOfDepth(const View& view, const PrimaryRay& ray, float depth) {
  const glm::dmat4 clipFromEyeSpace = clipFromEye(view);
  const glm::dvec3 originEye = glm::dvec3(ray.originWorld) - glm::dvec3(view.eyeWorld);
  const glm::dvec4 origin = clipFromEyeSpace * glm::dvec4(originEye, 1.0);
  const glm::dvec4 direction = clipFromEyeSpace * glm::dvec4(glm::dvec3(ray.directionWorld), 0.0);
  const double slope = direction.z - double{depth} * direction.w;
  return static_cast<float>((double{depth} * origin.w - origin.z) / slope);
}

} // namespace

FrameLayers readFrameLayers(const FrameTargets& targets, const View& view, std::uint32_t shadowedLights,
                            const std::vector<std::int32_t>& nodeOfInstance) {
  const std::size_t width = targets.size.x, height = targets.size.y;
  const std::vector<float> color = targets.color.readFloats(), normals = targets.normalWorldOct.readFloats(),
                           depth = targets.visibleDepth().readFloats();
  const std::vector<std::uint8_t> albedo = targets.albedo.read<std::uint8_t>();
  const std::vector<std::uint32_t> ids = targets.id.read<std::uint32_t>(), trace = targets.trace.read<std::uint32_t>();

  const std::vector<std::uint8_t> shadow =
      shadowedLights > 0 ? targets.shadow.read<std::uint8_t>() : std::vector<std::uint8_t>();

  FrameLayers layers;
  layers.size = targets.size;
  const std::size_t pixels = width * height;
  layers.color.resize(pixels);
  layers.depth.assign(pixels, std::numeric_limits<float>::infinity());
  layers.normal.assign(pixels, glm::vec3(0));
  layers.normalSurface.assign(pixels, glm::vec3(0));
  layers.albedo.assign(pixels, glm::vec3(0));
  layers.id.assign(pixels, -1);
  layers.kind.assign(pixels, SurfaceKind::None);
  layers.steps.assign(pixels, 0.0f);
  layers.shadow.assign(shadowedLights, std::vector<float>(pixels, 1.0f));
  const std::vector<float> open = targets.occlusion ? targets.occlusion.readFloats() : std::vector<float>{};
  layers.ambientOcclusion.resize(open.size());
  const std::vector<float> thickness = targets.thickness ? targets.thickness.readFloats() : std::vector<float>{};
  layers.thickness.resize(thickness.size());
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t source = (height - 1 - y) * width + x, p = y * width + x;
      layers.color[p] = {color[4 * source], color[4 * source + 1], color[4 * source + 2]};
      if (!open.empty()) layers.ambientOcclusion[p] = open[source];
      if (!thickness.empty()) layers.thickness[p] = thickness[source];
      const std::uint32_t kind = ids[source] & 3u;
      if (kind == shared::KIND_NONE) continue;
      const PrimaryRay ray = primaryRay(view, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      layers.depth[p] = rayParameterOfDepth(view, ray, depth[source]);
      layers.normal[p] = directionFromOctahedral({normals[4 * source], normals[4 * source + 1]});
      layers.normalSurface[p] = directionFromOctahedral({normals[4 * source + 2], normals[4 * source + 3]});
      layers.albedo[p] =
          linearFromSrgb(glm::vec3(albedo[4 * source], albedo[4 * source + 1], albedo[4 * source + 2]) / 255.0f);
      const std::uint32_t number = ids[source] >> 2;
      layers.id[p] = kind == shared::KIND_SDF ? nodeOfInstance[number] : static_cast<std::int32_t>(number);
      layers.kind[p] = kind == shared::KIND_MESH ? SurfaceKind::Mesh : SurfaceKind::Sdf;
      if (kind == shared::KIND_SDF) layers.steps[p] = static_cast<float>(trace[2 * source]);
      for (std::size_t light = 0; light < shadowedLights; ++light)
        layers.shadow[light][p] = static_cast<float>(shadow[4 * source + light]) / 255.0f;
    }
  return layers;
}

std::vector<std::uint32_t> readFrameShadowReads(const FrameTargets& targets) {
  const std::size_t width = targets.size.x, height = targets.size.y;
  std::vector<std::uint32_t> reads = targets.shadowReads.read<std::uint32_t>();
  for (std::size_t y = 0; y < height / 2; ++y)
    std::swap_ranges(reads.begin() + static_cast<std::ptrdiff_t>(y * width),
                     reads.begin() + static_cast<std::ptrdiff_t>((y + 1) * width),
                     reads.begin() + static_cast<std::ptrdiff_t>((height - 1 - y) * width));
  return reads;
}

std::vector<std::uint8_t> readFramePicture(const FrameTargets& targets) {
  const std::size_t width = targets.size.x, height = targets.size.y;
  const std::vector<std::uint8_t> rgba = targets.picture.read<std::uint8_t>();
  std::vector<std::uint8_t> rgb(width * height * 3);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) rgb[(y * width + x) * 3 + c] = rgba[((height - 1 - y) * width + x) * 4 + c];
  return rgb;
}

} // namespace brickfield
