// A multi-part EXR for each truth.
#include "app/shadow_truth.h"

#include "core/error.h"
#include "core/files.h"
#include "core/hash.h"
#ifdef BRICKFIELD_BAKERS
#include "app/layers_io.h"
#include "app/progress_bar.h"
#include "bakers/reference.h"
#endif

namespace brickfield {

#ifdef BRICKFIELD_BAKERS

namespace {

namespace fs = std::filesystem;

void addVector(Hasher& hasher, glm::vec3 value) { hasher.add(value.x).add(value.y).add(value.z); }

/// Of geometry as it is posed, camera and lights; materials decide no shadow but by their masks, whose images count.
std::string hashText(const ShadowTruthRequest& request) {
  constexpr std::uint32_t kVersion = 1; // of what the reference traces
  Hasher hasher;
  hasher.add(kVersion).add(request.samples).add(request.view.sizePixels.x).add(request.view.sizePixels.y);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      hasher.add(request.view.worldFromView[column][row]).add(request.view.clipFromView[column][row]);
  for (const PosedLight& posed : request.lighting.lights) {
    hasher.add(posed.light.kind).add(posed.light.angleRadians).add(posed.light.radius);
    hasher.add(posed.light.size.x).add(posed.light.size.y);
    addVector(hasher, posed.positionWorld), addVector(hasher, posed.directionWorld),
        addVector(hasher, posed.rightWorld);
  }
  for (const PosedInstance& instance : request.pose.instances) {
    hasher.add(instance.node).add(instance.mesh);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) hasher.add(instance.worldFromObject[column][row]);
    for (const glm::mat4& joint : instance.worldFromBind)
      for (int column = 0; column < 4; ++column) addVector(hasher, glm::vec3(joint[column]));
    hasher.addArray(instance.morphWeights);
  }
  for (const Mesh& mesh : request.scene.meshes)
    for (const Primitive& primitive : mesh.primitives) {
      hasher.addArray(primitive.indices).add(primitive.material);
      for (const glm::vec3& position : primitive.positions) addVector(hasher, position);
    }
  for (const Image& image : request.scene.images) hasher.addArray(image.rgba);
  return hasher.finish().text();
}

FrameLayers trace(const ShadowTruthRequest& request) {
  ReferenceRequest reference;
  reference.scene = &request.scene;
  reference.pose = &request.pose;
  reference.view = &request.view;
  reference.lighting = &request.lighting;
  reference.samples = request.samples;
  reference.threads = request.threads;
  reference.layersAlone = true;
  reference.shadowLayers = true;
  ProgressBar bar;
  return traceReference(reference, bar.progress());
}

} // namespace

std::optional<FrameLayers> shadowTruth(const ShadowTruthRequest& request) {
  std::error_code ec;
  fs::create_directories(request.folder, ec);
  const fs::path file = request.folder / (request.name + "-" + hashText(request) + ".exr");
  if (const std::string obstacle = obstacleToWriting(file); !obstacle.empty())
    throw BadInput("--truth", file.string(), obstacle);
  if (fs::is_regular_file(file, ec)) {
    try {
      FrameLayers layers = readLayers(file);
      if (layers.size == request.view.sizePixels && layers.shadow.size() == request.lighting.lights.size())
        return layers;
    } catch (const BadInput&) { // damaged: traced anew
    }
  }
  FrameLayers layers = trace(request);
  writeLayers(file, layers);
  return layers;
}

#else

std::optional<FrameLayers> shadowTruth(const ShadowTruthRequest&) { return {}; }

#endif

} // namespace brickfield
