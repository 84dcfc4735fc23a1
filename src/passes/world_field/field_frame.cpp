// A texture unit a cascade.
#include "passes/world_field/field_frame.h"

namespace brickfield {

void bindWorldField(const FieldFrame& field) {
  const auto bindVolume = [](GLuint unit, const Texture& volume) {
    volume.bind(unit);
    Sampler::unbind(unit);
  };
  if (field.exact) {
    field.exact->bindParams();
    field.exact->bindNodes();
    for (std::size_t i = 0; i < field.exact->windows().size(); ++i)
      bindVolume(shared::kWorldFieldUnit + static_cast<GLuint>(i), field.exact->distances(i));
  } else {
    field.rtsdfParams->bindUniform(shared::kFieldUniformBinding);
    bindVolume(shared::kWorldFieldUnit, field.rtsdf->volume());
  }
}

} // namespace brickfield
