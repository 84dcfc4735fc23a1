// The visible SDF objects of a frame, as the cull pass leaves them and every pass that draws boxes takes them.
#pragma once

#include "gpu/buffer.h"
#include "gpu/vertex_array.h"

namespace brickfield {

class VisibleBoxes {
public:
  VisibleBoxes();

  /// Room for this many instances in both halves of the list. Renews the buffers: not between cull and draw.
  void fit(std::uint32_t instanceCount);

  const Buffer& list() const { return list_; } ///< VISIBLE_* words: facing objects, then those cut by the near plane
  const Buffer& screenBoxes() const { return screenBoxes_; } ///< a count in 16 bytes, then shared::ScreenBox
  const Buffer& commands() const { return commands_; }       ///< shared::BoxCommand, BOX_COMMANDS of them

  /// One indirect draw for all boxes, with the program in use; shaders/passes/sdf_box.vert.glsl is its vertex shader.
  void draw() const;

private:
  Buffer list_, screenBoxes_, commands_;
  VertexArray vertexArray_;
};

} // namespace brickfield
