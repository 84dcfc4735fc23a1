// Walks the list once with the last write of every resource in hand, and the barriers since.
#include "renderer/frame_plan.h"

#include <array>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "gpu/gl.h"

namespace brickfield {

namespace {

bool isIncoherent(Access access) { return access == Access::ImageStore || access == Access::StorageWrite; }

// The bit that makes earlier incoherent writes visible to an access (OpenGL 4.5 core, 7.13.2).
std::uint32_t barrierFor(Access access) {
  switch (access) {
  case Access::Attachment:
    return GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT;
  case Access::Sampled:
    return GL_TEXTURE_FETCH_BARRIER_BIT;
  case Access::ImageStore:
    return GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
  case Access::StorageRead:
  case Access::StorageWrite:
    return GL_SHADER_STORAGE_BARRIER_BIT;
  case Access::Uniform:
    return GL_UNIFORM_BARRIER_BIT;
  case Access::VertexFetch:
    return GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT;
  case Access::Indirect:
    return GL_COMMAND_BARRIER_BIT;
  case Access::Upload:
    return GL_BUFFER_UPDATE_BARRIER_BIT;
  }
  return GL_ALL_BARRIER_BITS;
}

struct ResourceState {
  std::optional<Access> lastWrite;
  std::uint32_t barriersSince = 0; ///< that write: what it left is visible to these already
  bool isReadSince = false;        ///< since a barrier: passes that read it may still be running
};

// Passes between which nothing stands may run side by side.
std::uint32_t barrierBeforeRead(const ResourceState& state, Access access) {
  if (!state.lastWrite || !isIncoherent(*state.lastWrite)) return 0;
  return barrierFor(access) & ~state.barriersSince;
}

std::uint32_t barrierBeforeWrite(const ResourceState& state, Access access) {
  const bool wouldOvertake = state.isReadSince && isIncoherent(access);
  return barrierBeforeRead(state, access) | (wouldOvertake ? barrierFor(access) : 0);
}

} // namespace

void planFrame(std::vector<PlannedPass>& passes, const std::vector<ResourceUse>& provided) {
  std::array<ResourceState, kResourceCount> states;
  const auto stateOf = [&](Resource resource) -> ResourceState& { return states[static_cast<std::size_t>(resource)]; };
  for (const ResourceUse& use : provided) stateOf(use.resource).lastWrite = use.access;
  std::set<std::string> names;
  for (PlannedPass& pass : passes) {
    const PassDeclaration& declaration = pass.declaration;
    if (!names.insert(declaration.name).second)
      throw Failure(fmt::format("frame plan: two passes are named {}", declaration.name));
    pass.barriersBefore = 0;
    for (const ResourceUse& use : declaration.reads)
      if (!stateOf(use.resource).lastWrite)
        throw Failure(
            fmt::format("frame plan: {} reads {}, which nobody wrote", declaration.name, resourceName(use.resource)));
    for (const auto* reads : {&declaration.reads, &declaration.readsIfMade})
      for (const ResourceUse& use : *reads) pass.barriersBefore |= barrierBeforeRead(stateOf(use.resource), use.access);
    for (const ResourceUse& use : declaration.writes)
      pass.barriersBefore |= barrierBeforeWrite(stateOf(use.resource), use.access);
    if (pass.barriersBefore)
      for (ResourceState& state : states) state.barriersSince |= pass.barriersBefore, state.isReadSince = false;
    for (const auto* reads : {&declaration.reads, &declaration.readsIfMade})
      for (const ResourceUse& use : *reads) stateOf(use.resource).isReadSince = true;
    for (const ResourceUse& use : declaration.writes) stateOf(use.resource) = {use.access, 0, false};
  }
}

} // namespace brickfield
