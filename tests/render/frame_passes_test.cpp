// That `list passes` tells of the frame itself, and that its counts and its memory are those of what was drawn.
#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

using ::testing::HasSubstr;

class FramePasses : public GlTest {};

std::vector<std::string> namesOf(const std::vector<PassTime>& times) {
  std::vector<std::string> names;
  for (const PassTime& time : times) names.push_back(time.name);
  return names;
}

TEST_F(FramePasses, AreListedInTheirOrderAndNoOthers) {
  Scene built = makeInterpenetration();
  for (Node& node : built.nodes) node.sdf.triplanar = 1.0f;
  const TestScene scene(std::move(built), "Torus", 16);
  const auto renderer = scene.makeRenderer(context().info());
  const View view = scene.autoView({64, 36});
  const std::vector<std::string> listed = framePassNames();
  std::vector<std::string> seen;
  RendererSettings settings;
  settings.worldField.shape = {1, 16, 0, false};
  settings.worldField.rtsdf.coarseSize = settings.worldField.rtsdf.fineSize = 16;
  settings.shadowMaps = {ShadowFilter::Evsm, kLeastShadowTexels};
  for (const char* shown : {"", "steps", "albedo", "field", "field-surface", "shadow-map", "motion"}) {
    settings.view = shown;
    settings.shadows.method = settings.view.empty() ? ShadowMethod::Field : ShadowMethod::None;
    if (settings.view == "shadow-map") settings.shadows.method = ShadowMethod::Maps;
    if (settings.view == "albedo") settings.shadows.method = ShadowMethod::MapsAndField;
    settings.taa.on = settings.view == "motion";
    settings.sdfTracing = settings.view == "steps" ? SdfTracing::Tiles : SdfTracing::Boxes;
    settings.taa.shutter = 0.5f;
    settings.occlusion.form = settings.view == "steps" ? OcclusionForm::Cones : OcclusionForm::Off;
    settings.translucency.source = settings.view == "steps" ? TranslucencySource::Materials : TranslucencySource::Off;
    settings.reflections.method = settings.view == "field" ? ReflectionMethod::Field : ReflectionMethod::Off;
    settings.worldField.method = settings.view == "field" ? FieldMethod::Exact : FieldMethod::Rtsdf;
    renderer->setSettings(settings);
    renderer->render(view);
    const std::vector<std::string> names = namesOf(renderer->passTimes());
    auto from = listed.begin();
    for (const std::string& name : names) {
      from = std::find(from, listed.end(), name);
      ASSERT_NE(from, listed.end()) << name << " is not listed, or before its turn";
    }
    seen.insert(seen.end(), names.begin(), names.end());
  }
  for (const std::string& name : listed)
    EXPECT_NE(std::find(seen.begin(), seen.end(), name), seen.end()) << name << " is listed and never runs";
}

TEST_F(FramePasses, MeshesBesideTheViewAreNotDrawn) {
  const TestScene scene(makeInterpenetration(), "", 16);
  const auto renderer = scene.makeRenderer(context().info());
  renderer->render(scene.autoView({64, 36}));
  const FrameStats seen = renderer->stats();
  EXPECT_GT(seen.meshDraws, 0u);
  EXPECT_EQ(seen.meshVisible, seen.meshDraws);
  renderer->render(makePerspectiveView({0, 0, 50}, {0, 0, 100}, 0.7f, 0.1f, {64, 36}));
  EXPECT_EQ(renderer->stats().meshDraws, seen.meshDraws);
  EXPECT_EQ(renderer->stats().meshVisible, 0u);
}

bool makesField(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name.starts_with("world_") || name.starts_with("field_") || name.starts_with("rtsdf_") ||
           name == "hierarchy_refit";
  });
}

TEST_F(FramePasses, NoFieldIsMadeThatNobodyReads) {
  const TestScene scene(makeInterpenetration(), "Torus", 16);
  const auto renderer = scene.makeRenderer(context().info());
  RendererSettings settings;
  settings.worldField.shape = {1, 16, 0, false};
  EXPECT_EQ(settings.worldField.method, FieldMethod::Exact) << "the default";
  for (const char* shown : {"", "steps"}) {
    settings.view = shown;
    renderer->setSettings(settings);
    renderer->render(scene.autoView({32, 32}));
    EXPECT_FALSE(makesField(namesOf(renderer->passTimes()))) << shown;
    EXPECT_EQ(renderer->fieldStats().method, FieldMethod::Off);
    EXPECT_THROW(renderer->readWorldField(), Failure);
  }
  settings.worldField.always = true;
  renderer->setSettings(settings);
  renderer->render(scene.autoView({32, 32}));
  EXPECT_TRUE(makesField(namesOf(renderer->passTimes())));
  settings.worldField.method = FieldMethod::Off;
  renderer->setSettings(settings);
  renderer->render(scene.autoView({32, 32}));
  EXPECT_FALSE(makesField(namesOf(renderer->passTimes()))) << "off is off";
}

// The first frame makes all, one in which nothing moved none, and one in which the sphere moved what it reaches.
TEST_F(FramePasses, FieldIsCountedAsItIsMade) {
  const TestScene scene(makeInterpenetration(), "none");
  const auto renderer = scene.makeRenderer(context().info());
  RendererSettings settings;
  settings.worldField.shape = {2, 64, 0.02, false};
  settings.worldField.always = true;
  renderer->setSettings(settings);
  const View view = scene.autoView({32, 32});
  renderer->render(view);
  FieldStats stats = renderer->stats().field;
  EXPECT_EQ(stats.tiles, 2u * 512u);
  EXPECT_EQ(stats.keyTiles, stats.tiles);
  EXPECT_EQ(stats.valueTiles, stats.tiles);
  EXPECT_EQ(stats.movedInstances, 2u);
  const std::size_t texels = 2u * 64u * 64u * 64u;
  EXPECT_EQ(stats.bytes.distances, texels * 2);
  EXPECT_EQ(stats.bytes.nodes, texels * 4);
  EXPECT_GT(stats.bytes.work, texels * 4);
  EXPECT_GE(stats.bytes.triangles, stats.triangles * std::size_t{64});
  renderer->render(view);
  stats = renderer->stats().field;
  EXPECT_EQ(stats.valueTiles, 0u);
  EXPECT_EQ(stats.movedInstances, 0u);
  Pose pose = scene.pose();
  pose.instances[1].worldFromObject[3].x += 0.1f;
  renderer->setPose(pose);
  renderer->render(view);
  stats = renderer->stats().field;
  EXPECT_EQ(stats.movedInstances, 1u);
  EXPECT_GT(stats.keyTiles, 0u);
  EXPECT_LT(stats.keyTiles, stats.tiles);
}

// Where nothing is any more, nothing shows of the frame before.
TEST_F(FramePasses, BackgroundsForgetTheFrameBefore) {
  const TestScene scene(makeInterpenetration(), "Torus", 16);
  RendererSettings settings;
  settings.worldField.shape = {1, 16, 0, false};
  settings.shadows.method = ShadowMethod::Field;
  settings.occlusion.form = OcclusionForm::Cones;
  settings.translucency.source = TranslucencySource::Given;
  settings.reflections.method = ReflectionMethod::Field;
  const auto renderer = scene.makeRenderer(context().info(), settings);
  const auto other = scene.makeRenderer(context().info(), settings); // which never draws the near view
  const View near = scene.view({0, 0, 2}, {0, 0, 0}, {32, 32}), far = scene.view({0, 0, 9}, {0, 0, 0}, {32, 32});
  std::vector<std::string> shown{""};
  for (const DebugView& view : debugViews())
    if (!view.readsField && !view.readsShadowMaps && !view.readsTemporal) shown.push_back(view.name);
  using Way = std::pair<DrawOrder, SdfTracing>;
  for (const auto& [order, tracing] :
       {Way(DrawOrder::MeshesFirst, SdfTracing::Boxes), Way(DrawOrder::BoxesFirstAllReversed, SdfTracing::Boxes),
        Way(DrawOrder::MeshesFirst, SdfTracing::Tiles)})
    for (const std::string& name : shown) {
      settings.view = name;
      settings.drawOrder = order;
      settings.sdfTracing = tracing;
      renderer->setSettings(settings);
      other->setSettings(settings);
      renderer->render(near);
      renderer->render(far);
      other->render(far);
      EXPECT_EQ(renderer->readPicture(), other->readPicture()) << name;
    }
}

// What --view says of its colours is what the shader is told: red, no blue, from the named count on.
TEST_F(FramePasses, HeatViewsNameTheirRange) {
  for (const DebugView& view : debugViews())
    if (view.redAt > 0)
      EXPECT_THAT(view.meaning, HasSubstr(fmt::format("red {}", view.redAt)));
    else
      EXPECT_THAT(view.meaning, ::testing::Not(HasSubstr("red")));
}

// A torus and a sphere that pierces it: what is drawn, and what of it by its far faces because the eye is inside.
TEST_F(FramePasses, CountsAreThoseOfTheBoxes) {
  const TestScene scene(makeInterpenetration(), "all", 16);
  const auto renderer = scene.makeRenderer(context().info());
  renderer->render(scene.view({0.25f, 0.1f, 0.0f}, {0.25f, 0.1f, -3}, {64, 36}));
  FrameStats stats = renderer->stats();
  EXPECT_EQ(stats.sdfInstances, 2u);
  EXPECT_EQ(stats.sdfVisible, 2u);
  EXPECT_EQ(stats.sdfInside, 2u) << "the eye is inside both boxes";
  renderer->render(scene.view({0, 0, 5}, {0, 0, 0}, {64, 36}));
  stats = renderer->stats();
  EXPECT_EQ(stats.sdfVisible, 2u);
  EXPECT_EQ(stats.sdfInside, 0u);
  renderer->render(scene.view({0, 0, 5}, {0, 0, 10}, {64, 36}));
  stats = renderer->stats();
  EXPECT_EQ(stats.sdfVisible, 0u);
  renderer->render(scene.view({-0.7f, 0, 0.1f}, {3, 0, 0.1f}, {64, 36}));
  stats = renderer->stats();
  EXPECT_EQ(stats.sdfVisible, 2u);
  EXPECT_EQ(stats.sdfInside, 1u) << "the eye is inside the torus' box alone";
}

// Targets: 4 + 4 depths, 8 normals, 4 albedo, 4 material, 4 emission, 4 id, 8 trace, 4 shadow, 4 its reads,
// a quarter of 4 its half, 8 colour, 4 picture, 2 overdraw.
TEST_F(FramePasses, MemoryIsCountedByKind) {
  const TestScene scene(makeInterpenetration(), "Torus", 32);
  const auto renderer = scene.makeRenderer(context().info());
  renderer->render(scene.autoView({64, 36}));
  const GpuBytes bytes = renderer->stats().bytes;
  EXPECT_EQ(bytes.targets, 64u * 36u * 63u);
  std::size_t vertices = 0, indices = 0;
  for (const Mesh& mesh : scene.scene().meshes)
    for (const Primitive& primitive : mesh.primitives)
      vertices += primitive.positions.size(), indices += primitive.indices.size();
  EXPECT_GE(bytes.meshes, vertices * 48 + indices * 4);
  EXPECT_LT(bytes.meshes, vertices * 48 + indices * 4 + 4096);
  std::size_t bricks = 0;
  for (const BrickLevel& level : scene.fields().fields[0].levels) bricks += level.brickCount();
  EXPECT_GE(bytes.bricks, bricks * 512);
  EXPECT_GT(bytes.textures, 0u);
  EXPECT_GT(bytes.tables, 0u);
}

} // namespace
} // namespace brickfield::test
