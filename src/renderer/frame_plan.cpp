// Walks the list once with the last write of every resource in hand.
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

} // namespace

void planFrame(std::vector<PlannedPass>& passes, const std::vector<ResourceUse>& provided) {
  std::array<std::optional<Access>, kResourceCount> lastWrite;
  for (const ResourceUse& use : provided) lastWrite[static_cast<std::size_t>(use.resource)] = use.access;
  std::set<std::string> names;
  for (PlannedPass& pass : passes) {
    const PassDeclaration& declaration = pass.declaration;
    if (!names.insert(declaration.name).second)
      throw Failure(fmt::format("frame plan: two passes are named {}", declaration.name));
    pass.barriersBefore = 0;
    const auto require = [&](const ResourceUse& use) {
      const auto& last = lastWrite[static_cast<std::size_t>(use.resource)];
      if (last && isIncoherent(*last)) pass.barriersBefore |= barrierFor(use.access);
      return last.has_value();
    };
    for (const ResourceUse& use : declaration.reads)
      if (!require(use))
        throw Failure(
            fmt::format("frame plan: {} reads {}, which nobody wrote", declaration.name, resourceName(use.resource)));
    for (const ResourceUse& use : declaration.readsIfMade) require(use);
    for (const ResourceUse& use : declaration.writes) {
      require(use);
      lastWrite[static_cast<std::size_t>(use.resource)] = use.access;
    }
  }
}

} // namespace brickfield
