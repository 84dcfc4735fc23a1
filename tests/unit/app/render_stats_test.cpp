// What --stats says of a render that is put together by hand.
#include "app/render_stats.h"

#include <numbers>

#include <gtest/gtest.h>

namespace brickfield {
namespace {

/// Three frames of a scene with one triangle shown twice and one field that came from the cache, one that did not.
class RenderStats : public ::testing::Test {
protected:
  RenderStats() {
    Primitive triangle;
    triangle.indices = {0, 1, 2};
    scene_.meshes.push_back({"Triangle", {triangle}, {}});
    scene_.nodes.resize(3);
    pose_.instances.resize(2);
    for (PosedInstance& instance : pose_.instances) instance.mesh = 0;
    lighting_.lights.resize(4);
    fields_.fields.resize(2);
    device_.renderer = "a GPU";
    device_.version = "4.6 of a driver";
    request_.scene.path = "scene.glb";
    request_.camera.sizePixels = {64, 32};
    request_.frames = 3;
    run_.request = &request_, run_.scene = &scene_, run_.pose = &pose_;
    run_.lighting = &lighting_, run_.fields = &fields_, run_.device = &device_;
    run_.view = makePerspectiveView({1, 2, 3}, {1, 2, 0}, std::numbers::pi_v<float> / 3, 0.25f, {64, 32});
    run_.loadSeconds = 1.5, run_.bakeSeconds = 2.5, run_.drawSeconds = 3.5;
    run_.baked = 1;
    run_.frames = {frame(30, 8, 3), frame(10, 2, 5), frame(20, 4, 4)};
    run_.last.bytes = {1000, 200, 30, 4, 5000};
    run_.last.counters.fragments = 7;
    run_.last.counters.brickReads = 70;
  }

  /// The inner scope is a part of the mesh pass, so it does not add to the frame.
  static FrameTime frame(double cpu, double mesh, double lighting) {
    return {cpu, {{"mesh", mesh, 0}, {"mesh inner", mesh / 2, 1}, {"lighting", lighting, 0}}};
  }

  Scene scene_;
  Pose pose_;
  Lighting lighting_;
  SceneFields fields_;
  ContextInfo device_;
  RenderRequest request_;
  RenderRun run_;
};

TEST_F(RenderStats, TimesOfAllFramesAndPasses) {
  const nlohmann::ordered_json times = renderStatsJson(run_)["milliseconds"];
  EXPECT_EQ(times["frames_cpu"], (std::vector<double>{30, 10, 20}));
  EXPECT_EQ(times["frames_cpu_min"], 10.0);
  EXPECT_EQ(times["frames_cpu_median"], 20.0);
  EXPECT_EQ(times["frames_gpu"], (std::vector<double>{11, 7, 8}));
  EXPECT_EQ(times["frames_gpu_min"], 7.0);
  EXPECT_EQ(times["frames_gpu_median"], 8.0);
  EXPECT_EQ(times["frame"], 8.0) << "of the last frame";
  EXPECT_EQ(times["passes"]["mesh"], 4.0) << "of the last frame";
  EXPECT_EQ(times["passes_min"]["mesh"], 2.0);
  EXPECT_EQ(times["passes_median"]["mesh"], 4.0);
  EXPECT_EQ(times["passes_min"]["lighting"], 3.0);
  EXPECT_EQ(times["passes_median"]["lighting"], 4.0);
}

TEST_F(RenderStats, SecondsCacheMemoryAndCounts) {
  const nlohmann::ordered_json json = renderStatsJson(run_);
  EXPECT_EQ(json["seconds"], (nlohmann::ordered_json{{"load", 1.5}, {"bake", 2.5}, {"draw", 3.5}}));
  EXPECT_EQ(json["cache"]["hits"], 1);
  EXPECT_EQ(json["cache"]["misses"], 1);
  EXPECT_EQ(json["bytes"]["scene"], 1234);
  EXPECT_EQ(json["bytes"]["bricks"], 1000);
  EXPECT_EQ(json["bytes"]["meshes"], 200);
  EXPECT_EQ(json["bytes"]["textures"], 30);
  EXPECT_EQ(json["bytes"]["tables"], 4);
  EXPECT_EQ(json["bytes"]["targets"], 5000);
  EXPECT_GT(json["bytes"]["host_peak"], 1 << 20) << "no program that reads this takes less than a MiB";
  EXPECT_EQ(json["counts"]["fragments"], 7);
  EXPECT_EQ(json["counts"]["brick_reads"], 70);
  EXPECT_EQ(json["scene_counts"]["nodes"], 3);
  EXPECT_EQ(json["scene_counts"]["instances"], 2);
  EXPECT_EQ(json["scene_counts"]["triangles"], 2) << "as drawn: the mesh counts for each instance";
  EXPECT_EQ(json["scene_counts"]["lights"], 4);
}

TEST_F(RenderStats, HostPeakFollowsWhatWasTouched) {
  const std::size_t before = renderStatsJson(run_)["bytes"]["host_peak"];
  constexpr std::size_t kTouched = std::size_t{256} << 20;
  const std::vector<char> touched(before + kTouched, 1); // more than all of the peak before
  EXPECT_GE(renderStatsJson(run_)["bytes"]["host_peak"], before + kTouched) << touched.back();
}

TEST_F(RenderStats, SettingsInForceWhereNothingWasAsked) {
  const nlohmann::ordered_json settings = renderStatsJson(run_)["settings"];
  const nlohmann::ordered_json expected{{"size", {64, 32}},
                                        {"camera", "first, else auto"},
                                        {"eye", {1.0, 2.0, 3.0}},
                                        {"near", 0.25},
                                        {"time", "rest pose"},
                                        {"animation", "all"},
                                        {"frames", 3},
                                        {"trace", "boxes"},
                                        {"sdf", "extras"},
                                        {"resolution", "extras"},
                                        {"shadows", "none"},
                                        {"ao", {{"form", "off"}}},
                                        {"light", "scene"},
                                        {"environment", "sky"},
                                        {"exposure", 0.0},
                                        {"view", "picture"},
                                        {"seed", 0},
                                        {"device", "first that works"}};
  for (const auto& [key, value] : expected.items()) EXPECT_EQ(settings[key], value) << key;
  EXPECT_NEAR(settings["fov_degrees"], 60, 1e-3);
  EXPECT_NEAR(settings["forward"][2], -1, 1e-6);
}

TEST_F(RenderStats, SettingsAsAsked) {
  request_.camera.camera = "2";
  request_.scene.pose.seconds = 1.25;
  request_.scene.pose.animation = "Walk";
  request_.scene.sdf = {{"Dragon*", "Cup"}, 64};
  request_.light = {{"none"}, "sky.hdr"};
  request_.exposureEv = -1.5f;
  request_.view = "steps";
  request_.scene.seed = 9;
  request_.device = 2;
  const nlohmann::ordered_json settings = renderStatsJson(run_)["settings"];
  const nlohmann::ordered_json expected{{"camera", "2"},
                                        {"time", 1.25},
                                        {"animation", "Walk"},
                                        {"sdf", {"Dragon*", "Cup"}},
                                        {"resolution", 64},
                                        {"light", {"none"}},
                                        {"environment", "sky.hdr"},
                                        {"exposure", -1.5},
                                        {"view", "steps"},
                                        {"seed", 9},
                                        {"device", 2}};
  for (const auto& [key, value] : expected.items()) EXPECT_EQ(settings[key], value) << key;
}

TEST_F(RenderStats, SaysWhatItsTimersAreWorth) {
  nlohmann::ordered_json json = renderStatsJson(run_);
  EXPECT_EQ(json["timers"]["kind"], "queries");
  EXPECT_EQ(json["gpu"]["renderer"], "a GPU");
  EXPECT_EQ(json["gpu"]["version"], "4.6 of a driver");
  EXPECT_EQ(json["gpu"]["software"], false);
  device_.isSoftware = true;
  json = renderStatsJson(run_);
  EXPECT_EQ(json["timers"]["kind"], "software");
  EXPECT_NE(json["timers"]["meaning"].get<std::string>().find("glFinish"), std::string::npos);
  EXPECT_EQ(json["gpu"]["software"], true);
}

TEST_F(RenderStats, WorldFieldIsThatOfTheLastFrame) {
  EXPECT_EQ(renderStatsJson(run_)["world_field"], nlohmann::ordered_json({{"made", false}}));
  FieldStats& field = run_.frames.back().field;
  field.method = FieldMethod::Exact;
  field.cascades = 4, field.triangles = 12, field.movedInstances = 1;
  field.tiles = 100, field.keyTiles = 3, field.candidateTiles = 5, field.valueTiles = 7;
  field.bytes = {1000, 200, 30, 4, 50000};
  nlohmann::ordered_json json = renderStatsJson(run_)["world_field"];
  EXPECT_EQ(json["made"], true);
  EXPECT_EQ(json["moved_instances"], 1);
  EXPECT_EQ(json["tiles"]["all"], 100);
  EXPECT_EQ(json["tiles"]["keys"], 3);
  EXPECT_EQ(json["tiles"]["values"], 7);
  EXPECT_EQ(json["bytes"]["all"], 51234);
  EXPECT_EQ(json["bytes"]["nodes"], 4);
  field.method = FieldMethod::Rtsdf;
  EXPECT_FALSE(renderStatsJson(run_)["world_field"].contains("tiles"));
}

TEST_F(RenderStats, WorldFieldSettingsAreThoseOfItsMethod) {
  const auto settings = [&] { return renderStatsJson(run_)["settings"]["world_field"]; };
  EXPECT_EQ(settings()["method"], "exact");
  EXPECT_EQ(settings()["cascades"], 4);
  EXPECT_EQ(settings()["texel_metres"], "covers the scene");
  request_.field.settings.method = FieldMethod::Rtsdf;
  request_.field.settings.rtsdf.maskWidth = std::numeric_limits<float>::infinity();
  EXPECT_EQ(settings()["texels"], (nlohmann::ordered_json{256, 256, 256}));
  EXPECT_EQ(settings()["mask"], "inf");
  EXPECT_EQ(settings()["rays"], 5);
  request_.field.settings.rtsdf.bruteForce = true;
  EXPECT_EQ(settings()["texels"], (nlohmann::ordered_json{400, 200, 400}));
  EXPECT_FALSE(settings().contains("alpha"));
  request_.field.settings.method = FieldMethod::Off;
  EXPECT_EQ(settings(), nlohmann::ordered_json({{"method", "off"}}));
}

} // namespace
} // namespace brickfield
