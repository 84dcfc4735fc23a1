// The paper's tables 3 and 4, the published figure above ours.
#include "app/bench_tables.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/bench_floor.h"
#include "app/rtsdf_published.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

/// A row of a table: a name and a text a column.
void printRow(const std::string& name, const std::string& whose, const std::vector<std::string>& cells) {
  fmt::print("{:<22}{:<11}", name, whose);
  for (const std::string& cell : cells) fmt::print("{:>9}", cell);
  fmt::print("\n");
  std::fflush(stdout);
}

std::string millisecondsText(std::optional<double> milliseconds, int digits) {
  return milliseconds ? fmt::format("{:.{}f}", *milliseconds, digits) : "-";
}

Json orNull(std::optional<double> value) { return value ? Json(*value) : Json(nullptr); }

// Of a list of the paper's columns, where it has that one.
template <typename List, typename Value>
std::optional<std::size_t> columnOf(const List& columns, Value value) {
  const auto found = std::find(columns.begin(), columns.end(), value);
  if (found == columns.end()) return {};
  return static_cast<std::size_t>(found - columns.begin());
}

struct SizeColumn {
  int rays = 0;
  FieldTimes times;
  std::optional<double> publishedRays;
};

void printSizeRow(const std::string& name, const std::vector<SizeColumn>& columns,
                  const std::function<std::optional<double>(const SizeColumn&)>& published,
                  const std::function<double(const FieldTimes&)>& ours) {
  std::vector<std::string> above, below;
  for (const SizeColumn& column : columns) {
    above.push_back(millisecondsText(published(column), 2));
    below.push_back(millisecondsText(ours(column.times), 3));
  }
  printRow(name, "published", above);
  printRow("", "ours", below);
}

void printSize(const published::SizeRow& row, const std::vector<SizeColumn>& columns) {
  const auto sumOf = [&](const SizeColumn& column) -> std::optional<double> {
    if (!column.publishedRays) return {};
    return row.voxelize + row.flood + *column.publishedRays;
  };
  printSizeRow(
      "voxelization", columns, [&](auto&) { return row.voxelize; },
      [](auto& times) { return times.of("rtsdf_voxelize"); });
  printSizeRow(
      "jump flood", columns, [&](auto&) { return row.flood; },
      [](auto& times) { return times.of("rtsdf_jump_flood"); });
  printSizeRow(
      "ray trace", columns, [](auto& column) { return column.publishedRays; },
      [](auto& times) { return times.of("rtsdf_rays"); });
  printSizeRow("sum; ours with more", columns, sumOf, [](auto& times) { return times.milliseconds; });
  const std::vector<std::string> lighting(columns.size(), millisecondsText(row.lighting, 2));
  printRow("lighting, 3 lights", "published", lighting);
  printRow("", "ours", {"not here: `bench shadows` times the march of shadow rays"});
}

Json benchRtsdf(const BenchedScene& scene, const std::string& size, const published::SizeRow& row) {
  const FieldBenchRequest& request = scene.setting.request;
  const std::vector<int> rays =
      request.rays.empty() ? std::vector<int>(published::kSizeRays.begin(), published::kSizeRays.end()) : request.rays;
  std::vector<SizeColumn> columns;
  std::vector<std::string> titles;
  Json json = Json::array();
  for (const int count : rays) {
    RtsdfSettings settings = rtsdfOfSize(request, size);
    settings.raysPerTexel = count;
    const std::optional<std::size_t> place = columnOf(published::kSizeRays, count);
    columns.push_back(
        {count,
         scene.bench.timeRtsdf(settings, motionOf(scene.scene, scene.rest, FieldMotion::Everything), request.frames),
         place ? std::optional(row.rays[*place]) : std::nullopt});
    titles.push_back(fmt::format("x = {}", count));
    Json entry{{"size", size}, {"case", fmt::format("rtsdf x={}, all moving", count)}};
    entry.update(jsonOf(columns.back().times));
    entry["published_ms"] = {{"rtsdf_voxelize", row.voxelize},
                             {"rtsdf_jump_flood", row.flood},
                             {"rtsdf_rays", orNull(columns.back().publishedRays)},
                             {"lighting", row.lighting}};
    json.push_back(std::move(entry));
  }
  printRow("rtsdf, all moving, ms", "", titles);
  printSize(row, columns);
  const FieldTimes& last = columns.back().times;
  fmt::print("more: hierarchy refit {:.3f}, world triangles {:.3f}, deform {:.3f}; {:.0f} MiB\n",
             last.of("hierarchy_refit"), last.of("world_triangles"), last.of("deform"),
             static_cast<double>(last.bytes) / 1048576.0);
  return json;
}

Json benchExact(const BenchedScene& scene, const std::string& size) {
  const FieldBenchRequest& request = scene.setting.request;
  const DeviceRates rates = ratesOf(request, scene.setting.device.renderer);
  Json json = Json::array();
  for (const auto& [name, motion] : {std::pair{"exact, all moving", FieldMotion::Everything},
                                     {"exact, mover", FieldMotion::Mover},
                                     {"exact, still", FieldMotion::Nothing}}) {
    const FieldTimes times =
        scene.bench.timeExact(shapeOfSize(size), motionOf(scene.scene, scene.rest, motion), request.frames);
    fmt::print("{:<18}{:9.3f} ms | apart:{} | tiles {} keys {} values | plan {:.3f} ms of the CPU | {:.0f} MiB\n", name,
               times.milliseconds, passesText(times), times.tiles.keys, times.tiles.values, times.planMilliseconds,
               static_cast<double>(times.bytes) / 1048576.0);
    if (times.tiles.values > 0) fmt::print("{:<18}{}\n", "", floorText(times, rates));
    std::fflush(stdout);
    Json entry{{"size", size}, {"case", name}};
    entry.update(jsonOf(times));
    entry["floor"] = floorJson(times, rates);
    json.push_back(std::move(entry));
  }
  return json;
}

} // namespace

FieldShape shapeOfSize(const std::string& size) {
  RtsdfSettings settings;
  setRtsdfSize(settings, size);
  return {1, settings.fineSize, 0, true};
}

RtsdfSettings rtsdfOfSize(const FieldBenchRequest& request, const std::string& size) {
  RtsdfSettings settings;
  setRtsdfSize(settings, size);
  settings.seed = static_cast<std::uint32_t>(request.scene.seed ^ request.scene.seed >> 32);
  return settings;
}

Json jsonOf(const FieldTimes& times) {
  Json passes = Json::object();
  for (const PassTime& pass : times.passes) passes[pass.name] = pass.milliseconds;
  return {
      {"passes_ms", passes},
      {"update_ms", times.milliseconds},
      {"plan_ms", times.planMilliseconds},
      {"tiles", {{"keys", times.tiles.keys}, {"candidates", times.tiles.candidates}, {"values", times.tiles.values}}},
      {"triangles_gathered", times.gathered},
      {"triangles_drawn", times.drawn},
      {"sdf_objects", times.sdfObjects},
      {"bytes", times.bytes}};
}

std::string passesText(const FieldTimes& times) {
  std::string text;
  for (const PassTime& pass : times.passes)
    if (pass.milliseconds > 0.0005) text += fmt::format(" {} {:.3f}", pass.name, pass.milliseconds);
  return text;
}

Json benchSizeTable(const BenchedScene& scene) {
  Json json = Json::array();
  for (const published::SizeRow& row : published::kSizes) {
    const std::string size(row.size);
    const std::vector<std::string>& asked = scene.setting.request.sizes;
    if (std::find(asked.begin(), asked.end(), size) == asked.end()) continue;
    const RtsdfSettings settings = rtsdfOfSize(scene.setting.request, size);
    fmt::print("\nTable 3, size {}: coarse {}, fine {}\n", size, settings.coarseSize, settings.fineSize);
    for (const Json& entry : benchRtsdf(scene, size, row)) json.push_back(entry);
    for (const Json& entry : benchExact(scene, size)) json.push_back(entry);
  }
  return json;
}

Json benchMaskTable(const BenchedScene& scene) {
  const FieldBenchRequest& request = scene.setting.request;
  const std::string& size = scene.setting.mainSize();
  const auto orPublished = [](const auto& asked, const auto& columns) {
    return asked.empty() ? std::decay_t<decltype(asked)>(columns.begin(), columns.end()) : asked;
  };
  const std::vector<int> rays = orPublished(request.rays, published::kMaskRays);
  const std::vector<float> masks = orPublished(request.masks, published::kMaskWidths);
  fmt::print("\nTable 4: the ray pass of rtsdf at size {}{}, all moving, ms\n", size,
             size == "M" ? "" : "; the paper's is M");
  std::vector<std::string> titles;
  for (const float mask : masks) titles.push_back(std::isinf(mask) ? "d = inf" : fmt::format("d = {:g}", mask));
  printRow("", "", titles);
  Json json{{"size", size}, {"rows", Json::array()}};
  for (const int count : rays) {
    std::vector<std::string> above, below;
    for (const float mask : masks) {
      RtsdfSettings settings = rtsdfOfSize(request, size);
      settings.raysPerTexel = count;
      settings.maskWidth = mask;
      const double ours =
          scene.bench.timeRtsdf(settings, motionOf(scene.scene, scene.rest, FieldMotion::Everything), request.frames)
              .of("rtsdf_rays");
      const auto row = columnOf(published::kMaskRays, count), column = columnOf(published::kMaskWidths, mask);
      std::optional<double> theirs;
      if (row && column) theirs = published::kMasks[*row][*column];
      above.push_back(millisecondsText(theirs, 2));
      below.push_back(millisecondsText(ours, 3));
      json["rows"].push_back({{"rays", count},
                              {"mask", std::isinf(mask) ? Json("inf") : Json(mask)},
                              {"rays_ms", ours},
                              {"published_ms", orNull(theirs)}});
    }
    printRow(fmt::format("x = {}", count), "published", above);
    printRow("", "ours", below);
  }
  fmt::print("Exact: has neither rays nor a mask; its whole update is in table 3.\n");
  return json;
}

} // namespace brickfield
