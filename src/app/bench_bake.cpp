// Geometry alone is compared: both get the same triangles, textures and masks left out, and make one narrow band of the
// same voxel, ours of four voxels to each side with its codes, OpenVDB's of three. Once with sides: ours judges which
// parts are sheets and closes the holes of the others, OpenVDB has inside what its voxels shut in. Once without, where
// both do the same work: distances to the triangles. Runs of all four alternate and medians are taken.
#ifdef BRICKFIELD_BAKERS
#include "app/bench_bake.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/image_io.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/peak_memory.h"
#include "app/session.h"
#include "bakers/band_accuracy.h"
#include "bakers/openvdb_band.h"
#include "core/error.h"
#include "core/files.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kErrorWork = 4e7; // samples times triangles: a second or two
constexpr double kMebi = 1024.0 * 1024.0;

/// The thesis' table 1: seconds of its converter, and of a game engine's that works by a kd-tree.
struct ThesisRow {
  const char* file; ///< that holds the mesh
  const char* what;
  int resolution;
  double converterSeconds, engineSeconds;
};
constexpr std::array<ThesisRow, 3> kThesis = {
    {{"box.glb", "cube, 24^3", 24, 0.0072, 1.9},
     {"utah_teapot_2464.glb", "teapot, 2,464 triangles, 128x74x89", 128, 8.05, 118.4},
     {"stanford_dragon_100k.glb", "dragon, 100k triangles, 42x31x22", 42, 9.97, 6.5}}};

/// A file's mesh: as it is, and as bare geometry.
struct BenchMesh {
  std::string name;
  Scene scene, bareScene;
  BakeInput input, bareInput;
};

BakeInput inputOf(const Scene& scene, const BakeBenchRequest& request, const std::filesystem::path& path) {
  const Pose pose = poseScene(scene, {});
  if (!request.isJoined) {
    const auto triangles = [&](const PosedInstance& instance) {
      std::size_t indices = 0;
      for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives)
        indices += primitive.indices.size();
      return indices;
    };
    const auto largest = std::max_element(pose.instances.begin(), pose.instances.end(),
                                          [&](auto& a, auto& b) { return triangles(a) < triangles(b); });
    if (largest == pose.instances.end()) throw BadInput(path.string(), "", "has no mesh in its scene");
    return bakeInputOf(scene, *largest, pose);
  }
  BakeInput joined;
  joined.label = path.filename().string();
  joined.scene = &scene;
  for (const PosedInstance& instance : pose.instances) {
    BakeInput part = bakeInputOf(scene, instance);
    for (std::size_t i = 0; i < part.primitives.size(); ++i) {
      for (glm::vec3& position : part.positionsObject[i])
        position = glm::vec3(instance.worldFromObject * glm::vec4(position, 1.0f));
      joined.primitives.push_back(part.primitives[i]);
      joined.positionsObject.push_back(std::move(part.positionsObject[i]));
    }
  }
  if (joined.primitives.empty()) throw BadInput(path.string(), "", "has no mesh in its scene");
  return joined;
}

std::unique_ptr<BenchMesh> loadMesh(const std::filesystem::path& path, const BakeBenchRequest& request) {
  auto mesh = std::make_unique<BenchMesh>();
  mesh->name = path.stem().string() + (request.isJoined ? " (joined)" : "");
  mesh->scene = importGltf(path);
  mesh->bareScene = mesh->scene;
  for (Material& material : mesh->bareScene.materials) {
    Material bare;
    bare.doubleSided = material.doubleSided;
    material = bare;
  }
  mesh->input = inputOf(mesh->scene, request, path);
  mesh->bareInput = inputOf(mesh->bareScene, request, path);
  return mesh;
}

/// Seconds by the clock, and of all threads together: on a machine that does other work, only the latter can be
/// compared.
struct TimeTaken {
  double seconds = 0, processorSeconds = 0;
};

TimeTaken timeOf(const std::function<void()>& work) {
  const std::clock_t processor = std::clock();
  const auto start = std::chrono::steady_clock::now();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

template <typename Value, typename Key>
Value medianBy(std::vector<Value> values, const Key& key) {
  std::sort(values.begin(), values.end(), [&](const Value& a, const Value& b) { return key(a) < key(b); });
  return values[values.size() / 2];
}

PeerMesh peerMeshOf(const BakeInput& input, double voxelMetres) {
  PeerMesh mesh;
  for (std::size_t p = 0; p < input.primitives.size(); ++p) {
    const auto first = static_cast<std::uint32_t>(mesh.positionsVoxels.size());
    for (const glm::vec3 position : input.positionsObject[p])
      mesh.positionsVoxels.emplace_back(glm::dvec3(position) / voxelMetres);
    const std::vector<std::uint32_t>& indices = input.primitives[p]->indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      mesh.triangles.emplace_back(first + indices[i], first + indices[i + 1], first + indices[i + 2]);
  }
  return mesh;
}

/// Several runs of the same work.
struct Runs {
  std::vector<TimeTaken> taken;

  void add(TimeTaken time) { taken.push_back(time); }
  bool isEmpty() const { return taken.empty(); }
  TimeTaken median() const {
    const auto ofOne = [&](double TimeTaken::*member) {
      return medianBy(taken, [member](const TimeTaken& time) { return time.*member; }).*member;
    };
    return {ofOne(&TimeTaken::seconds), ofOne(&TimeTaken::processorSeconds)};
  }
};

/// A band by us and by OpenVDB.
struct BandRuns {
  Runs ours, peer;

  double timesOurs() const { return peer.median().seconds / ours.median().seconds; }
  double processorTimesOurs() const { return peer.median().processorSeconds / ours.median().processorSeconds; }
};

/// What was measured of a mesh at a resolution.
struct BenchRow {
  BakeStats ours; ///< of the median run
  std::optional<std::uint64_t> ourPeak, peerPeak;
  BandRuns withSides, withoutSides;
  PeerVoxels peerVoxels; ///< with sides
  BandAccuracy accuracy;
  bool isOpen = false; ///< distances near membranes are theirs
  std::optional<double> fullSeconds;
};

BakeSettings settingsOf(const BakeBenchRequest& request, int resolution) {
  BakeSettings settings;
  settings.resolution = resolution;
  settings.sign = request.sign;
  settings.threads = request.threads;
  return settings;
}

BenchRow measure(const BenchMesh& mesh, const BakeBenchRequest& request, int resolution) {
  const BakeSettings settings = settingsOf(request, resolution);
  BakeSettings settingsWithoutSides = settings;
  settingsWithoutSides.sign = SignMethod::TwoSided;
  BenchRow row;
  std::vector<BakeStats> runs;
  for (int i = 0; i < request.repeats; ++i) {
    throwIfInterrupted();
    std::optional<PeakMemory> peak(std::in_place);
    BandBake band, flat;
    PeerBand peer, flatPeer;
    row.withSides.ours.add(timeOf([&] { band = bakeBand(mesh.bareInput, settings); }));
    if (i == 0) row.ourPeak = peak->bytes();
    runs.push_back(band.stats);
    row.withoutSides.ours.add(timeOf([&] { flat = bakeBand(mesh.bareInput, settingsWithoutSides); }));
    if (!isBuiltWithOpenVdb()) continue;
    const auto peerBand = [&](const BandBake& ours, PeerSides sides) {
      return bandByOpenVdb(peerMeshOf(mesh.bareInput, ours.level.voxelSizeObject), sides, request.threads);
    };
    peak.emplace();
    row.withSides.peer.add(timeOf([&] { peer = peerBand(band, PeerSides::Told); }));
    if (i == 0) row.peerPeak = peak->bytes();
    row.withoutSides.peer.add(timeOf([&] { flatPeer = peerBand(flat, PeerSides::NotTold); }));
    if (i == 0) row.peerVoxels = countVoxels(peer);
  }
  row.ours = medianBy(runs, [](const BakeStats& stats) { return stats.seconds; });
  BakeSettings plain = settings;
  plain.sign = SignMethod::Winding; // no slabs, no solids drawn thicker: distances are those to triangles
  const BandBake band = bakeBand(mesh.bareInput, plain);
  const auto affordable =
      static_cast<std::size_t>(std::clamp(kErrorWork / static_cast<double>(row.ours.triangles), 64.0, 5000.0));
  row.accuracy = measureBand(band, request.errorSamples > 0 ? request.errorSamples : affordable);
  row.isOpen = band.stats.openEdges > 0;
  if (request.withFullBake) row.fullSeconds = bakeField(mesh.input, settings).stats.seconds;
  return row;
}

std::string mebibytesText(std::optional<std::uint64_t> bytes) {
  return bytes ? fmt::format("{:.1f}", static_cast<double>(*bytes) / kMebi) : "-";
}

std::string peerText(const BandRuns& runs) {
  return fmt::format("{:8.1f} {:6.2f}x {:6.2f}x", runs.peer.median().seconds * 1e3, runs.timesOurs(),
                     runs.processorTimesOurs());
}

void printRow(const BenchMesh& mesh, int resolution, const BenchRow& row) {
  const BakeSeconds& stages = row.ours.stages;
  const double withoutSides = row.withoutSides.ours.median().seconds * 1e3;
  const std::string peer = row.withSides.peer.isEmpty()
                               ? fmt::format("  not built with OpenVDB |{:>9.1f}", withoutSides)
                               : fmt::format("{:>8} {} |{:>9.1f} {}", mebibytesText(row.peerPeak),
                                             peerText(row.withSides), withoutSides, peerText(row.withoutSides));
  fmt::print("{:<36}{:>5}{:>9.1f} |{:>8.1f}{:>8.1f}{:>8.1f}{:>8.1f}{:>7.1f} |{:>8}{:>8.2f}{:>8}{:>7.1f} "
             "|{:>10}{:>9.1e}{:>6} |{:>8} |{}\n",
             mesh.name, resolution, row.ours.seconds * 1e3, stages.gather * 1e3, stages.hierarchy * 1e3,
             stages.distance * 1e3, stages.sign * 1e3, stages.packing * 1e3, row.ours.bricks,
             static_cast<double>(row.ours.queries) / stages.distance * 1e-6, mebibytesText(row.ourPeak),
             static_cast<double>(row.ours.hierarchyBytes) / static_cast<double>(row.ours.triangles),
             row.isOpen ? "open" : fmt::format("{:.1e}", row.accuracy.largestError), row.accuracy.largestCodedError,
             row.accuracy.wrongSigns, row.fullSeconds ? fmt::format("{:.0f}", *row.fullSeconds * 1e3) : "-", peer);
  std::fflush(stdout);
}

template <typename Value>
Json orNull(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json jsonOf(const BenchMesh& mesh, int resolution, const BenchRow& row) {
  const BakeStats& ours = row.ours;
  const auto peerOf = [](const BandRuns& runs) -> Json {
    if (runs.peer.isEmpty()) return "not built with OpenVDB";
    return {{"seconds", runs.peer.median().seconds},
            {"processor_seconds", runs.peer.median().processorSeconds},
            {"times_ours", runs.timesOurs()},
            {"processor_times_ours", runs.processorTimesOurs()}};
  };
  Json peer = peerOf(row.withSides);
  if (peer.is_object()) {
    peer["peak_bytes"] = orNull(row.peerPeak);
    peer["active_voxels"] = row.peerVoxels.active;
    peer["inside_voxels"] = row.peerVoxels.inside;
  }
  return {
      {"mesh", mesh.name},
      {"resolution", resolution},
      {"triangles", ours.triangles},
      {"seconds", ours.seconds},
      {"processor_seconds", row.withSides.ours.median().processorSeconds},
      {"stage_seconds",
       {{"gather", ours.stages.gather},
        {"hierarchy", ours.stages.hierarchy},
        {"distance", ours.stages.distance},
        {"sign", ours.stages.sign},
        {"packing", ours.stages.packing}}},
      {"bricks", ours.bricks},
      {"queries", ours.queries},
      {"queries_per_second", static_cast<double>(ours.queries) / ours.stages.distance},
      {"peak_bytes", orNull(row.ourPeak)},
      {"hierarchy_bytes_per_triangle", static_cast<double>(ours.hierarchyBytes) / static_cast<double>(ours.triangles)},
      {"sign", ours.sign},
      {"error_samples", row.accuracy.samples},
      {"error_voxels", row.isOpen ? Json(nullptr) : Json(row.accuracy.largestError)},
      {"coded_error_voxels", row.isOpen ? Json(nullptr) : Json(row.accuracy.largestCodedError)},
      {"quantum_voxels", row.accuracy.quantum},
      {"wrong_signs", row.accuracy.wrongSigns},
      {"full_bake_seconds", orNull(row.fullSeconds)},
      {"openvdb", std::move(peer)},
      {"without_sides",
       {{"seconds", row.withoutSides.ours.median().seconds},
        {"processor_seconds", row.withoutSides.ours.median().processorSeconds},
        {"openvdb", peerOf(row.withoutSides)}}}};
}

void printHead(const BakeBenchRequest& request) {
  fmt::print(
      "One band of distances, signs and codes from triangles, {} threads, medians of {}; ms, MiB, voxels. Beside it "
      "OpenVDB's meshToVolume, 3 voxels to each side, of the same triangles and voxels (x: how much longer it takes, "
      "by the clock and in processor time). Of open meshes ours tells sheets from solids and closes holes, OpenVDB has "
      "inside what its voxels shut in; \"no sides\": the same bands by both without any inside, distances alone.\n"
      "Errors and signs against brute force in double, of a band without slabs; \"full\": with mips and "
      "attributes.\n\n",
      request.threads, request.repeats);
  fmt::print("{:<36}{:>5}{:>9} |{:>8}{:>8}{:>8}{:>8}{:>7} |{:>8}{:>8}{:>8}{:>7} |{:>10}{:>9}{:>6} |{:>8} |{}\n", "mesh",
             "res", "ours", "gather", "tree", "dist.", "sign", "pack", "bricks", "Mq/s", "peak", "B/tri", "error",
             "coded", "signs", "full", "    peak  OpenVDB  clock   proc. | no sides  OpenVDB  clock   proc.");
}

Json benchThesis(const BakeBenchRequest& request) {
  Json json = Json::array();
  bool isHeadPrinted = false;
  for (const std::filesystem::path& path : request.meshPaths)
    for (const ThesisRow& row : kThesis) {
      if (path.filename() != row.file) continue;
      if (!std::exchange(isHeadPrinted, true))
        fmt::print(
            "\nThe thesis' table 1, seconds (its converter, a game engine's, ours; ours all levels, no attributes)\n");
      BakeBenchRequest largest = request;
      largest.isJoined = false;
      const std::unique_ptr<BenchMesh> mesh = loadMesh(path, largest);
      BakeSettings settings = settingsOf(request, row.resolution);
      settings.attributes = false;
      std::vector<double> runs;
      for (int i = 0; i < request.repeats; ++i) runs.push_back(bakeField(mesh->bareInput, settings).stats.seconds);
      const double ours = medianBy(runs, [](double seconds) { return seconds; });
      fmt::print("{:<36}{:>10.4f}{:>10.1f}{:>10.4f}\n", row.what, row.converterSeconds, row.engineSeconds, ours);
      json.push_back({{"what", row.what},
                      {"resolution", row.resolution},
                      {"thesis_seconds", row.converterSeconds},
                      {"engine_seconds", row.engineSeconds},
                      {"seconds", ours}});
    }
  return json;
}

} // namespace

void runBakeBench(const BakeBenchRequest& request) {
  const std::vector<OutputPath> outputs{{"--json", request.json, {".json"}}};
  checkOutputs(outputs, request.meshPaths);
  for (const std::filesystem::path& path : request.meshPaths) checkInputPath(path, {".gltf", ".glb"});
  printHead(request);
  Json rows = Json::array();
  for (const std::filesystem::path& path : request.meshPaths) {
    const std::unique_ptr<BenchMesh> mesh = loadMesh(path, request);
    for (const int resolution : request.resolutions) {
      const BenchRow row = measure(*mesh, request, resolution);
      printRow(*mesh, resolution, row);
      rows.push_back(jsonOf(*mesh, resolution, row));
    }
  }
  Json figures{{"threads", request.threads}, {"repeats", request.repeats}, {"bakes", std::move(rows)}};
  figures["thesis"] = benchThesis(request);
  if (!request.json.empty()) writeFile(request.json, figures.dump(2) + "\n");
}

} // namespace brickfield
#endif
