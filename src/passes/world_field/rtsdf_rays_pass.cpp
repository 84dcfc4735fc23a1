// One thread a texel of the field; see the shader.
#include "passes/world_field/rtsdf_rays_pass.h"

#include <limits>

#include "shared/rtsdf_params.h"

namespace brickfield {

RtsdfRaysPass::RtsdfRaysPass(ShaderLibrary& shaders)
    : program_(shaders.load({"rtsdf_rays", {{GL_COMPUTE_SHADER, "passes/rtsdf_rays.comp.glsl"}}, {}, {}})),
      countingProgram_(shaders.load(
          {"rtsdf_rays_counting", {{GL_COMPUTE_SHADER, "passes/rtsdf_rays.comp.glsl"}}, {{"COUNTERS_ON", "1"}}, {}})) {}

PassDeclaration RtsdfRaysPass::declare() {
  // The frame before is read as well, but this pass itself made it.
  return {"rtsdf_rays",
          {{Resource::WorldTriangles, Access::StorageRead},
           {Resource::TriangleHierarchy, Access::StorageRead},
           {Resource::WorldFieldCoarse, Access::Sampled}},
          {{Resource::WorldField, Access::StorageWrite}, {Resource::WorldField, Access::ImageStore}}};
}

void RtsdfRaysPass::record(RtsdfField& field, const TriangleHierarchy& hierarchy, const Buffer& triangles) {
  dispatch(*program_, field, hierarchy, triangles);
}

RtsdfCounts RtsdfRaysPass::recordCounting(RtsdfField& field, const TriangleHierarchy& hierarchy,
                                          const Buffer& triangles) {
  Buffer counters("rtsdf_counters", shared::RTSDF_COUNTERS * sizeof(std::uint32_t));
  counters.clear();
  counters.bindStorage(shared::kRtsdfCounterBinding);
  dispatch(*countingProgram_, field, hierarchy, triangles);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const std::vector<std::uint32_t> words = counters.read<std::uint32_t>();
  const auto count = [&](std::uint32_t word) { return std::uint64_t{words[word + 1]} << 32 | words[word]; };
  return {count(shared::RTSDF_COUNT_TEXELS), count(shared::RTSDF_COUNT_RAYS), count(shared::RTSDF_COUNT_HITS),
          count(shared::RTSDF_COUNT_NODES), count(shared::RTSDF_COUNT_TRIANGLES)};
}

void RtsdfRaysPass::dispatch(Program& program, RtsdfField& field, const TriangleHierarchy& hierarchy,
                             const Buffer& triangles) {
  const RtsdfSettings& settings = field.settings();
  hierarchy.bind(program, triangles);
  field.shortest().bindStorage(shared::kRtsdfDistanceBinding);
  field.votes().bindStorage(shared::kRtsdfVoteBinding);
  field.coarse().bind(shared::kRtsdfCoarseUnit);
  Sampler::unbind(shared::kRtsdfCoarseUnit);
  field.volume().bindImage(shared::kRtsdfFieldUnit, 0, GL_WRITE_ONLY);
  program.set("extent", field.extent());
  // GLSL leaves remainders of negative numbers open.
  program.set("firstSlot", (glm::ivec3(field.cascade().window) % field.extent() + field.extent()) % field.extent());
  program.set("originAnchored", field.originAnchored());
  program.set("texelSize", field.cascade().texel.x);
  program.set("frameNumber", field.frame());
  program.set("seed", settings.seed);
  program.set("raysPerTexel", static_cast<std::uint32_t>(settings.raysPerTexel));
  program.set("decay", settings.decay);
  // An infinite uniform is no more certain to compare right than the largest float.
  program.set("maskTexels", std::min(field.texelsOf(settings.maskWidth), std::numeric_limits<float>::max()));
  program.set("biasTexels", field.texelsOf(settings.bias));
  program.set("farthestTexels", field.cascade().texel.z);
  program.set("isFirst", field.frame() == 0);
  program.set("bruteForce", settings.bruteForce);
  program.set("signByVote", settings.signByVote);
  program.dispatchOver(field.extent());
  field.finishFrame();
}

} // namespace brickfield
