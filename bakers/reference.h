// The reference image: Embree primary rays against the source triangles, with the renderer's camera and materials.
// Direct light of suns, spheres and rectangles with soft shadows, or of points with hard ones or none; environment
// light with ambient occlusion or without; reflections of the scene or of the surroundings alone. What the renderer is
// measured against.
#pragma once

#include <functional>
#include <optional>

#include "core/progress.h"
#include "field/brick_field.h"
#include "scene/brdf.h"
#include "scene/frame_layers.h"
#include "scene/lighting.h"
#include "scene/view.h"

namespace brickfield {

/// SDF objects that are traced as their own finest bricks.
struct ReferenceFields {
  const std::vector<BrickField>* fields = nullptr;
  const std::vector<int>* fieldOfNode = nullptr; ///< as many as nodes; -1: its triangles
  /// Of nodes whose fields have no attributes: metres that the textures of their mesh's first material span, projected
  /// along the axes of object space; 0, or nothing at all: white and rough.
  const std::vector<float>* triplanarOfNode = nullptr;
};

struct ReferenceRequest {
  const Scene* scene = nullptr;
  const Pose* pose = nullptr;
  const View* view = nullptr;
  const Lighting* lighting = nullptr;
  std::function<bool(int node)> isSdf; ///< marks the `kind` layer; what is traced, `fields` says
  bool shadows = true; ///< false: lights shine from their centres through everything, as in a renderer without shadows
  int samples = 1;     ///< a pixel, and of each light and the hemisphere a pixel; one alone goes through the centre
  std::uint64_t seed = 0;
  int threads = 0;                ///< 0: all
  bool lightsFromCentres = false; ///< every light a point or a direction: hard shadows
  bool layersAlone = false;       ///< no colour: a ray a pixel and what its layers ask for
  bool shadowLayers = false;      ///< make FrameLayers::shadow, unless without shadows, of the first 32 lights
  int reflections = 0;            ///< so often is a ray mirrored; what it meets then mirrors the surroundings alone
  std::optional<float> ambientOcclusionMetres{}; ///< what lies nearer hides the environment, and makes the layer
  ReferenceFields fields{};                      ///< empty: triangles alone
  BrdfModel brdf = BrdfModel::CookTorrance;      ///< that answers direct light
};

/// The picture's expectation over seeds is that of infinitely many samples, with more than one sample a pixel; a ray
/// through the pixel's centre makes all layers but colour, with `samples` shadow and occlusion rays. The same bytes on
/// any number of threads. Shadow and occlusion rays are stopped by both sides of surfaces and pass the holes of masks;
/// the hemisphere is that of the triangle, not of smoothed normals. Ambient occlusion dims all environment light, as
/// occlusion maps do, but for mirrored rays, which meet what stands around. A field whose node is nearly flat or scaled
/// beyond a million stays a mesh.
///
/// Back faces of single-sided materials are culled, alpha masks are cut; layers as FrameLayers says.
/// error Cancelled; Failure from Embree; BadInput: the scene reaches beyond 1e11 metres, the eye beyond that
/// proved by tests/oracle/bakers/reference_test.cpp, area_lights_test.cpp, reference_fields_test.cpp
FrameLayers traceReference(const ReferenceRequest& request, const Progress& progress = {});

} // namespace brickfield
