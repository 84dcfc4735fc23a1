// The renderer's public face: a scene and a view in, a picture and its layers out.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/timer.h"
#include "renderer/field_keeper.h"
#include "renderer/settings.h"
#include "resident/resident_scene.h"
#include "scene/frame_layers.h"
#include "scene/lighting.h"
#include "scene/view.h"

namespace brickfield {

/// Sums over one frame; zero where counters are off.
struct FrameCounters {
  std::uint32_t fragments = 0; ///< box fragments shaded
  std::uint32_t hits = 0;
  std::uint32_t steps = 0;
  std::uint32_t brickReads = 0;
  std::uint32_t promiseBroken = 0;  ///< depths in front of the box face: must be 0
  std::uint32_t outOfSteps = 0;     ///< rays that ran out of steps
  std::uint32_t shadowReads = 0;    ///< of the world field, for shadows
  std::uint32_t occlusionReads = 0; ///< of it, for ambient occlusion
  std::uint32_t mapFragments = 0;   ///< box fragments in shadow maps
  std::uint32_t mapSteps = 0;
  std::uint32_t insideSteps = 0;     ///< trace steps of rays within objects, for translucency
  std::uint32_t reflectionReads = 0; ///< of the world field and of bricks beside it
};

/// What the GPU holds, by kind; as asked for, without what a driver adds.
struct GpuBytes {
  std::size_t bricks = 0;   ///< atlas, indirection and levels
  std::size_t meshes = 0;   ///< vertices, indices, joints' influences, morph targets
  std::size_t textures = 0; ///< of materials and of the environment
  std::size_t tables = 0;   ///< what a pose renews: draws, instances, joints, lights
  std::size_t targets = 0;
  std::size_t shadowMaps = 0;
  std::size_t temporal = 0; ///< motion vectors and histories
};

struct FrameStats {
  std::vector<PassTime> passes;
  FrameCounters counters;
  std::uint32_t sdfInstances = 0;
  std::uint32_t sdfVisible = 0; ///< boxes drawn
  std::uint32_t sdfInside = 0;  ///< of them, with the near plane through the box
  std::uint32_t meshDraws = 0;
  std::uint32_t meshVisible = 0; ///< of them, drawn for the camera
  std::uint32_t bricks = 0;
  std::uint32_t shadowMapLayers = 0;
  std::uint32_t shadowMapDraws = 0; ///< of meshes, in all layers
  std::uint32_t shadowMapBoxes = 0; ///< of SDF objects; zero where counters are off
  GpuBytes bytes;
  FieldStats field;
};

/// Draws one scene on the context that is current when it is made; every call needs that context current. Several may
/// live in one process.
class Renderer {
public:
  /// error BadInput: no shader folder; Failure: a shader does not compile
  explicit Renderer(const ContextInfo& info);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// Uploads; frees what was there before. The scene must outlive the next setScene.
  void setScene(const Scene& scene, const SceneFields& fields);
  void setPose(Pose pose);
  void setLighting(const Lighting& lighting);
  /// Another kind or size of world field begins anew.
  /// error BadInput from checkSettings
  void setSettings(const RendererSettings& settings);

  /// Draws into own targets of the view's size. The world field is brought up to date where something of the frame
  /// reads it, or the settings say always.
  /// error Failure: no scene, pose or lighting was set; picture larger than the device allows
  void render(const View& view);

  /// Reads the frame back; rows from the top. With the shadow layers of a frame that has shadows.
  FrameLayers readLayers() const;
  /// Distances read at each pixel for the shadows of a frame that counted; rows from the top.
  std::vector<std::uint32_t> readShadowReads() const;
  /// The picture after the tone curve, or the debug view: RGB8, rows from the top.
  std::vector<std::uint8_t> readPicture() const;
  /// Times, counts and memory of the last frame.
  FrameStats stats();
  /// Times of the last frame's passes alone; waits for the GPU.
  std::vector<PassTime> passTimes();
  /// Of the last frame.
  FieldStats fieldStats() const;
  /// The world field of the last frame that made one; waits for the GPU.
  /// error Failure: there was none
  FieldVolumes readWorldField() const;
  /// Where the plane of the field views lay in that frame.
  FieldPicture fieldPicture() const;

  /// Motion vectors of the last frame, which had temporal antialiasing: pixels to the right and downwards from where a
  /// surface was in the frame before; rows from the top.
  /// error Failure: it had none
  std::vector<glm::vec2> readMotion() const;
  /// Depths of a layer of the last frame's shadow maps, reverse Z; rows from the bottom, as the views count.
  /// error Failure: there is no such layer
  std::vector<float> readShadowMap(int layer) const;
  /// Of squares of its texels the depths nearest to the light and farthest; level 0: of two by two, rows likewise.
  /// error Failure: there is no such layer or level, or the shadows were not of maps and field
  std::vector<glm::vec2> readShadowRange(int layer, int level) const;
  /// The views that they were drawn from, a layer each.
  const std::vector<ShadowView>& shadowViews() const;

  /// Compiles changed shader files anew; a line for each program that changed.
  std::vector<std::string> reloadShaders();

private:
  friend std::vector<std::string> framePassNames();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Names of all passes that a frame may have, in the order of the frame plan: with both methods of the world field,
/// though a frame has one at most, and the picture, the debug views and those of the field, of which it has one.
/// proved by tests/render/frame_passes_test.cpp
std::vector<std::string> framePassNames();

} // namespace brickfield
