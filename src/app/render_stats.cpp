// One object; names as in FrameStats.
#include "app/render_stats.h"

namespace brickfield {

nlohmann::ordered_json renderStatsJson(const RenderRequest& request, const ContextInfo& info, const FrameStats& stats) {
  nlohmann::ordered_json json;
  json["scene"] = request.scene.path.string();
  json["size"] = {request.camera.sizePixels.x, request.camera.sizePixels.y};
  json["frames"] = request.frames;
  json["seed"] = request.scene.seed;
  json["gpu"] = {
      {"renderer", info.renderer}, {"vendor", info.vendor}, {"version", info.version}, {"platform", info.platform}};
  double total = 0;
  nlohmann::ordered_json passes;
  for (const PassTime& pass : stats.passes) {
    passes[pass.name] = pass.milliseconds;
    if (pass.depth == 0) total += pass.milliseconds;
  }
  json["milliseconds"] = {{"frame", total}, {"passes", passes}};
  json["counts"] = {{"sdf_instances", stats.sdfInstances},
                    {"sdf_visible", stats.sdfVisible},
                    {"sdf_near_plane", stats.sdfInside},
                    {"mesh_draws", stats.meshDraws},
                    {"bricks", stats.bricks},
                    {"fragments", stats.counters.fragments},
                    {"hits", stats.counters.hits},
                    {"steps", stats.counters.steps},
                    {"brick_reads", stats.counters.brickReads},
                    {"promise_broken", stats.counters.promiseBroken},
                    {"out_of_steps", stats.counters.outOfSteps}};
  json["bytes"] = {{"scene", stats.sceneBytes}, {"targets", stats.targetBytes}};
  return json;
}

} // namespace brickfield
