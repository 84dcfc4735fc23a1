// The lists of tiles are ascending, so that the shader finds a tile in them by halving.
#include "passes/debug/field_view_pass.h"

#include <array>

#include "passes/world_field/field_frame.h"

namespace brickfield {

FieldViewPass::FieldViewPass(ShaderLibrary& shaders)
    : program_(shaders.load({"field_view", {{GL_COMPUTE_SHADER, "debug/field_view.comp.glsl"}}, {}, {}})) {}

PassDeclaration FieldViewPass::declare() {
  return {"field_view",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::WorldField, Access::Sampled},
           {Resource::WorldField, Access::StorageRead}},
          {{Resource::Picture, Access::ImageStore}}};
}

void FieldViewPass::record(const FrameContext& context) {
  const FieldFrame& field = *context.field;
  bindWorldField(field);
  glm::uvec3 counts(0);
  if (field.exact) {
    using List = ExactField::List;
    constexpr std::array<List, 3> kShown = {List::Keys, List::Candidates, List::Values};
    for (GLuint i = 0; i < kShown.size(); ++i) {
      field.exact->list(kShown[i]).bindStorage(shared::kFieldShownListBinding + i);
      counts[static_cast<glm::length_t>(i)] = field.exact->lengthOf(kShown[i]);
    }
  }
  program_->set("tileCounts", counts);
  program_->set("centerAnchored", field.picture.centerAnchored);
  program_->set("rightAnchored", field.picture.rightAnchored);
  program_->set("upAnchored", field.picture.upAnchored);
  program_->set("shownCascade", field.picture.cascade);
  context.targets.picture.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.picture.width(), context.targets.picture.height(), 1});
}

} // namespace brickfield
