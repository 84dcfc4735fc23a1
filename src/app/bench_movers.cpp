// One bench a crowd.
#include "app/bench_movers.h"

#include <fmt/format.h>

#include "app/bench_floor.h"
#include "app/bench_tables.h"
#include "core/error.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

Json benchCrowd(const FieldBenchSetting& setting, const MoverCrowd& crowd) {
  FieldBench bench(setting.device, crowd.scene, crowd.fields);
  const DeviceRates rates = ratesOf(setting.request, setting.device.renderer);
  const FieldShape& shape = setting.request.moverShape;
  const FieldTimes times = bench.timeExact(shape, motionOf(crowd), setting.request.frames);
  fmt::print("{:>7} movers {:9.3f} ms | apart:{} | tiles {} values | plan {:.3f} ms of the CPU | {:.0f} MiB\n",
             crowd.centers.size(), times.milliseconds, passesText(times), times.tiles.values, times.planMilliseconds,
             static_cast<double>(times.bytes) / 1048576.0);
  fmt::print("{:<15}{}\n", "", floorText(times, rates));
  std::fflush(stdout);
  Json json{{"movers", crowd.centers.size()}, {"cascades", shape.cascades}, {"texels", shape.texels}};
  json.update(jsonOf(times));
  json["floor"] = floorJson(times, rates);
  return json;
}

} // namespace

Json benchMovers(const FieldBenchSetting& setting) {
  const SceneFields fields = bakeBenchFields(setting);
  if (fields.fields.empty())
    throw BadInput(setting.scene.name, "", "has no SDF object to move; choose nodes with --sdf");
  fmt::print("SDF objects of {:g} m, {:g} m apart, on circles of {:g} m, all moving, in {} cascades of {}^3; {} "
             "different.\nMilliseconds, medians of {} frames.\n",
             kMoverSize, kMoverSpacing, kMoverCircle, setting.request.moverShape.cascades,
             setting.request.moverShape.texels, fields.fields.size(), setting.request.frames);
  Json json = Json::array();
  for (const int count : setting.request.moverCounts)
    json.push_back(benchCrowd(setting, makeMoverCrowd(setting.scene, fields, count)));
  return json;
}

} // namespace brickfield
