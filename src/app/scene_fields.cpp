// Nodes that share mesh, pose and settings share a field: the content hash of the bake tells. What is left is baked
// several at once, as far as the memory allows.
#include "app/scene_fields.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "bakers/bake_memory.h"
#include "bakers/job_pool.h"
#include "core/error.h"

namespace brickfield {

namespace {

bool hasArea(const BakeInput& input) {
  for (std::size_t p = 0; p < input.primitives.size(); ++p) {
    const auto& indices = input.primitives[p]->indices;
    const auto& positions = input.positionsObject[p];
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const glm::vec3 a = positions[indices[i]], b = positions[indices[i + 1]], c = positions[indices[i + 2]];
      if (glm::cross(b - a, c - a) != glm::vec3(0)) return true;
    }
  }
  return false;
}

struct FieldJob {
  const PosedInstance* instance = nullptr; ///< whose mesh it is
  BakeSettings settings;
  std::uint64_t mostBytes = 0; ///< of memory
  BakeResult result;
  bool wasCached = false;
};

/// Which fields the scene needs; nodes that get none are named in result.warnings.
std::vector<FieldJob> planJobs(const Scene& scene, const Pose& pose,
                               const std::vector<std::optional<BakeSettings>>& settingsOfNode,
                               SceneFieldsResult& result) {
  std::vector<FieldJob> jobs;
  std::vector<bool> done(scene.nodes.size(), false);
  std::map<Hash128, int> fieldOfHash;
  for (const PosedInstance& instance : pose.instances) {
    const std::size_t node = static_cast<std::size_t>(instance.node);
    if (done[node] || !settingsOfNode[node]) continue;
    done[node] = true;
    const BakeSettings& settings = *settingsOfNode[node];
    const BakeInput input = bakeInputOf(scene, instance, pose);
    if (glm::determinant(glm::mat3(instance.worldFromObject)) == 0.0f) {
      result.warnings.push_back(nodeLabel(scene, instance.node) + ": its transform flattens space, so it stays a mesh");
      continue;
    }
    if (!hasArea(input)) {
      result.warnings.push_back(nodeLabel(scene, instance.node) + ": its mesh has no area, so it stays a mesh");
      continue;
    }
    const auto [entry, isNew] = fieldOfHash.try_emplace(bakeHash(input, settings), static_cast<int>(jobs.size()));
    if (isNew) {
      std::size_t triangles = 0;
      for (const Primitive* primitive : input.primitives) triangles += primitive->indices.size() / 3;
      FieldJob& job = jobs.emplace_back();
      job.instance = &instance;
      job.settings = settings;
      job.mostBytes = mostBakeBytes(settings.resolution, triangles);
    }
    result.fields.fieldOfNode[node] = entry->second;
  }
  return jobs;
}

/// Bakes that run at once report how many of them are done; one that runs alone reports for itself.
class JobProgress {
public:
  JobProgress(const Progress& progress, std::size_t count) : progress_(progress), count_(count) {}

  Progress ofJob(bool isAlone) const { return {isAlone ? progress_.report : nullptr, progress_.cancelled}; }
  void finishJob() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (progress_.report && count_ > 1) progress_.report(fmt::format("bake {} fields", count_), done_, count_);
  }

private:
  const Progress& progress_;
  std::size_t count_, done_ = 0;
  std::mutex mutex_;
};

void bakeJobs(const Scene& scene, const Pose& pose, std::vector<FieldJob>& jobs,
              const std::filesystem::path& cacheFolder, const Progress& progress) {
  if (jobs.empty()) return;
  const int threads = jobs.front().settings.threads;
  JobProgress shared(progress, jobs.size());
  const auto bake = [&](FieldJob& job, bool isAlone) {
    if (progress.isCancelled()) throw Cancelled();
    job.result = bakeCached(bakeInputOf(scene, *job.instance, pose), job.settings, cacheFolder, shared.ofJob(isAlone),
                            &job.wasCached);
    shared.finishJob();
  };
  // Those that could not all be held at once, were each lane to bake the largest, go one after another.
  const std::uint64_t lanes = threads > 0 ? static_cast<std::uint64_t>(threads) : std::thread::hardware_concurrency();
  std::vector<FieldJob*> small, large;
  for (FieldJob& job : jobs) {
    const bool fits =
        job.settings.memoryBytes == 0 || job.mostBytes <= job.settings.memoryBytes / std::max(lanes, std::uint64_t{1});
    (fits ? small : large).push_back(&job);
  }
  for (FieldJob* job : large) bake(*job, true);
  runJobs(small.size(), threads, [&](std::size_t i) { bake(*small[i], small.size() == 1); });
}

} // namespace

std::string thinPartsWarning(const std::string& label, const BrickField& field, const BakeSettings& settings) {
  const ThinParts& thin = field.thinParts;
  if (thin.resolution == 0) return {};
  const double voxelMetres = field.levels.front().voxelSizeObject;
  const std::string remedy = thin.resolution <= kMostResolution
                                 ? fmt::format("(--resolution {})", thin.resolution)
                                 : fmt::format("(more than --resolution {})", kMostResolution);
  return fmt::format("{}: {:.0f} % of its closed surface bounds parts thinner than a voxel of {:.2g} m, which {}; "
                     "voxels of {:.2g} m would do {}",
                     label, 100.0 * thin.perTenThousand / ThinParts::kWhole, voxelMetres,
                     settings.sign == SignMethod::Auto ? "are drawn thicker" : "may have holes",
                     voxelMetres * settings.resolution / thin.resolution, remedy);
}

SceneFieldsResult bakeSceneFields(const Scene& scene, const Pose& pose,
                                  const std::vector<std::optional<BakeSettings>>& settingsOfNode,
                                  const std::filesystem::path& cacheFolder, const Progress& progress) {
  SceneFieldsResult result;
  result.fields.fieldOfNode.assign(scene.nodes.size(), -1);
  std::vector<FieldJob> jobs = planJobs(scene, pose, settingsOfNode, result);
  bakeJobs(scene, pose, jobs, cacheFolder, progress);
  for (FieldJob& job : jobs) {
    // A folder without room for a cache says so for every field; once is enough.
    auto& warnings = result.warnings;
    const std::string& cacheWarning = job.result.cacheWarning;
    if (!cacheWarning.empty() && std::find(warnings.begin(), warnings.end(), cacheWarning) == warnings.end())
      warnings.push_back(cacheWarning);
    const std::string label = nodeLabel(scene, job.instance->node);
    if (std::string warning = thinPartsWarning(label, job.result.field, job.settings); !warning.empty())
      warnings.push_back(std::move(warning));
    result.fields.fields.push_back(std::move(job.result.field));
    if (!job.wasCached) ++result.baked;
  }
  return result;
}

} // namespace brickfield
