// The list is an instance attribute: base instances reach it without any extension.
#include "passes/visible_boxes.h"

#include "shared/sdf_params.h"

namespace brickfield {

VisibleBoxes::VisibleBoxes()
    : list_("visible_boxes", 0),
      screenBoxes_("screen_boxes", 0),
      commands_("visible_box_commands", shared::BOX_COMMANDS * sizeof(shared::BoxCommand)),
      vertexArray_("visible_boxes") {
  fit(1);
}

void VisibleBoxes::fit(std::uint32_t instanceCount) {
  list_.growTo(2 * std::size_t{instanceCount} * sizeof(std::uint32_t));
  screenBoxes_.growTo(sizeof(glm::uvec4) + std::size_t{instanceCount} * sizeof(shared::ScreenBox));
  vertexArray_.setVertexBuffer(0, list_, sizeof(std::uint32_t));
  vertexArray_.setIntegerAttribute(0, 0, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayBindingDivisor(vertexArray_.id(), 0, 1);
}

void VisibleBoxes::draw() const {
  vertexArray_.bind();
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
  glMultiDrawArraysIndirect(GL_TRIANGLES, nullptr, shared::BOX_COMMANDS, 0);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

} // namespace brickfield
