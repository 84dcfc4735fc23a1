// Dispatches over the tile lists, one work group a tile.
#include "passes/world_field/exact_passes.h"

#include <algorithm>
#include <filesystem>

namespace brickfield {

namespace {

// Named as its file.
std::shared_ptr<Program> loadCompute(ShaderLibrary& shaders, const std::string& path) {
  return shaders.load({std::filesystem::path(path).stem().stem().string(), {{GL_COMPUTE_SHADER, path}}, {}, {}});
}

// One work group an entry; what one dimension cannot hold goes to a second (lib/field_grid.glsl listIndex).
void dispatchGroups(Program& program, std::uint32_t count) {
  constexpr std::uint32_t kMostGroups = 32768; // of the 65535 that are promised
  program.use();
  glDispatchCompute(std::min(count, kMostGroups), ceilDivide(count, kMostGroups), 1);
}

void dispatchList(Program& program, std::uint32_t length) {
  if (length == 0) return;
  program.set("listLength", length);
  dispatchGroups(program, length);
}

void betweenDispatches() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); }

// Of work whose number the GPU alone knows; each takes some until none is left.
constexpr GLuint kPartGroups = 2048, kBandGroups = 8192, kSearchGroups = 4096;

} // namespace

FieldClearPass::FieldClearPass(ShaderLibrary& shaders) : clear_(loadCompute(shaders, "passes/field_clear.comp.glsl")) {}

PassDeclaration FieldClearPass::declare() { return {"field_clear", {}, {{Resource::FieldKeys, Access::StorageWrite}}}; }

void FieldClearPass::record(const ExactField& field) {
  if (field.lengthOf(ExactField::List::Keys) == 0) return;
  field.bindParams();
  field.bindKeys();
  field.bindTiles();
  field.bindParts();
  field.bindList(ExactField::List::Keys);
  dispatchList(*clear_, field.lengthOf(ExactField::List::Keys));
}

FieldSplatPass::FieldSplatPass(ShaderLibrary& shaders)
    : splat_(loadCompute(shaders, "passes/field_splat.comp.glsl")),
      parts_(loadCompute(shaders, "passes/field_splat_parts.comp.glsl")) {}

PassDeclaration FieldSplatPass::declare() {
  return {
      "field_splat", {{Resource::WorldTriangles, Access::StorageRead}}, {{Resource::FieldKeys, Access::StorageWrite}}};
}

void FieldSplatPass::record(const ExactField& field, const Buffer& triangles) {
  if (field.splatCount() == 0) return;
  field.bindParams();
  field.bindKeys();
  field.bindParts();
  triangles.bindStorage(shared::kWorldTriangleBinding);
  field.bindSplats();
  dispatchList(*splat_, field.splatCount());
  betweenDispatches();
  parts_->use();
  glDispatchCompute(kPartGroups, 1, 1);
}

FieldCandidatesPass::FieldCandidatesPass(ShaderLibrary& shaders)
    : seeds_(loadCompute(shaders, "passes/field_seeds.comp.glsl")),
      sweep_(loadCompute(shaders, "passes/field_sweep.comp.glsl")),
      candidates_(loadCompute(shaders, "passes/field_candidates.comp.glsl")) {}

PassDeclaration FieldCandidatesPass::declare() {
  return {"field_candidates",
          {{Resource::WorldTriangles, Access::StorageRead}, {Resource::FieldKeys, Access::StorageRead}},
          {{Resource::FieldCandidates, Access::StorageWrite}}};
}

void FieldCandidatesPass::sweep(const ExactField& field) {
  for (const bool isDepth : {false, true}) {
    const ExactField::List list = isDepth ? ExactField::List::Depths : ExactField::List::Planes;
    field.bindList(list);
    sweep_->set("isDepth", isDepth);
    dispatchList(*sweep_, field.lengthOf(list));
    betweenDispatches();
  }
}

void FieldCandidatesPass::record(const ExactField& field, const Buffer& triangles) {
  if (field.lengthOf(ExactField::List::Candidates) == 0) return;
  field.bindParams();
  triangles.bindStorage(shared::kWorldTriangleBinding);
  field.bindKeys();
  field.bindSeeds();
  field.bindSweeps();
  field.bindCandidates();
  field.bindTiles();
  field.bindList(ExactField::List::Keys);
  dispatchList(*seeds_, field.lengthOf(ExactField::List::Keys));
  betweenDispatches();
  field.band().bindStorage(shared::kFieldNewBandBinding);
  sweep(field);
  field.bindList(ExactField::List::Candidates);
  dispatchList(*candidates_, field.lengthOf(ExactField::List::Candidates));
}

FieldResolvePass::FieldResolvePass(ShaderLibrary& shaders)
    : evaluate_(loadCompute(shaders, "passes/field_evaluate.comp.glsl")),
      refine_(loadCompute(shaders, "passes/field_refine.comp.glsl")),
      refineListed_(shaders.load(
          {"field_refine_listed", {{GL_COMPUTE_SHADER, "passes/field_refine.comp.glsl"}}, {{"LISTED", "1"}}, {}})),
      farValues_(loadCompute(shaders, "passes/field_far_values.comp.glsl")),
      far_(loadCompute(shaders, "passes/field_far.comp.glsl")),
      sides_(loadCompute(shaders, "passes/field_sides.comp.glsl")),
      objects_(loadCompute(shaders, "passes/field_objects.comp.glsl")),
      objectsOfFlipped_(shaders.load(
          {"field_objects_flipped", {{GL_COMPUTE_SHADER, "passes/field_objects.comp.glsl"}}, {{"FLIPPED", "1"}}, {}})),
      search_(loadCompute(shaders, "passes/field_objects_search.comp.glsl")),
      store_(loadCompute(shaders, "passes/field_objects_store.comp.glsl")),
      nearestPoints_(shaders) {}

PassDeclaration FieldResolvePass::declare() {
  return {"field_resolve",
          {{Resource::WorldTriangles, Access::StorageRead},
           {Resource::FieldKeys, Access::StorageRead},
           {Resource::FieldCandidates, Access::StorageRead},
           {Resource::Pseudonormals, Access::StorageRead},
           {Resource::SdfScene, Access::StorageRead}},
          {{Resource::WorldField, Access::ImageStore}}};
}

void FieldResolvePass::makeSides(ExactField& field) {
  constexpr std::uint32_t kTilesOfGroup = 16;
  field.flips().bindStorage(shared::kFieldFlipBinding);
  sides_->set("tileCount", field.tileCount());
  dispatchGroups(*sides_, ceilDivide(field.tileCount(), kTilesOfGroup));
}

void FieldResolvePass::joinObjects(const ExactField& field, const ResidentScene& scene) {
  constexpr GLbitfield kResults = GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
  glMemoryBarrier(kResults | GL_COMMAND_BARRIER_BIT);
  scene.atlas().bind();
  scene.bindSdfInstances();
  field.bindObjects();
  field.bindSearches();
  field.bindList(ExactField::List::Values);
  objects_->use();
  nearestPoints_.bind(*objects_);
  dispatchList(*objects_, field.lengthOf(ExactField::List::Values));
  field.flips().bindStorage(shared::kFieldFlipBinding);
  objectsOfFlipped_->use();
  nearestPoints_.bind(*objectsOfFlipped_);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, field.flips().id());
  glDispatchComputeIndirect(0);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
  glMemoryBarrier(kResults);
  search_->use();
  nearestPoints_.bind(*search_);
  glDispatchCompute(kSearchGroups, 1, 1);
  betweenDispatches();
  store_->use();
  glDispatchCompute(kSearchGroups, 1, 1);
}

void FieldResolvePass::resolveBand(const ExactField& field) {
  const std::uint32_t candidates = field.lengthOf(ExactField::List::Candidates);
  const auto dispatchBand = [&](Program& program) {
    if (candidates == 0) return;
    field.band().bindStorage(shared::kFieldBandBinding);
    program.use();
    glDispatchCompute(std::min(candidates, kBandGroups), 1, 1);
    betweenDispatches();
  };
  dispatchBand(*evaluate_);
  if (field.lengthOf(ExactField::List::Values) == candidates) {
    dispatchBand(*refine_);
    return;
  }
  // Where SDF objects moved alone, values of meshes are made again from the triangles that were found before.
  field.bindList(ExactField::List::Values);
  dispatchList(*refineListed_, field.lengthOf(ExactField::List::Values));
  betweenDispatches();
}

void FieldResolvePass::record(ExactField& field, const Buffer& triangles, const ResidentScene& scene) {
  if (!field.hasWork()) return;
  if (scene.sdfInstanceCount() > 0) {
    scene.atlas().bind();
    nearestPoints_.fit(scene);
  }
  field.clearCounts();
  field.bindParams();
  triangles.bindStorage(shared::kWorldTriangleBinding);
  field.bindKeys();
  field.bindCandidates();
  field.bindTiles();
  field.bindNodes();
  field.bindSides();
  for (std::size_t cascade = 0; cascade < field.windows().size(); ++cascade)
    field.distances(cascade).bindImage(static_cast<GLuint>(cascade), 0, GL_READ_WRITE);
  resolveBand(field);
  field.bindList(ExactField::List::Values);
  betweenDispatches();
  dispatchList(*farValues_, field.lengthOf(ExactField::List::Values));
  betweenDispatches();
  makeSides(field); // of other tiles, side by side with those to come
  field.bindList(ExactField::List::Values);
  dispatchList(*far_, field.lengthOf(ExactField::List::Values));
  if (scene.sdfInstanceCount() > 0) joinObjects(field, scene);
}

} // namespace brickfield
