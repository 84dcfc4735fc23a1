// The command of the dispatch comes first, then the count, then the entries.
#include "passes/work_list.h"

#include <glm/glm.hpp>

#include "gpu/gl.h"
#include "gpu/program.h"
#include "shared/bindings.h"

namespace brickfield {

WorkList::WorkList(std::string label) : buffer_(std::move(label), 0) {}

void WorkList::begin(std::size_t mostEntries) {
  const glm::uvec4 empty(0, 0, 1, 0); // groups, entries
  buffer_.growTo(sizeof(empty) + mostEntries * sizeof(std::uint32_t));
  buffer_.uploadValue(empty);
  buffer_.bindStorage(shared::kWorkListBinding);
}

void WorkList::dispatch(const Program& program) const {
  buffer_.bindStorage(shared::kWorkListBinding);
  program.use();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer_.id());
  glDispatchComputeIndirect(0);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

} // namespace brickfield
