// The flag --shadows, which render and reference share.
#pragma once

#include <string>

#include "passes/light/shadow_maps.h"

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

/// What `--shadows` can be told. Traced from whole lights, Hard from their centres: by the reference. Field: by the
/// renderer, marching the world field. Csm: by shadow maps. The union of both is refused until the renderer has it.
enum class ShadowChoice { Traced, Hard, Field, Csm, None };

/// --shadows of render: field, csm or none, which is its default.
/// error  BadInput at parsing: csm+field, which the renderer does not have yet; any other word
void addRenderShadows(CLI::App& command, ShadowChoice& choice);
/// --shadow-filter --shadow-size
void addShadowMapOptions(CLI::App& command, ShadowMapSettings& settings);
const char* shadowFilterName(ShadowFilter filter);

/// --shadows of reference: none; hard, from the lights' centres; or any of render's other words, for all of which it
/// traces exact ones from whole lights; these are its default.
void addReferenceShadows(CLI::App& command, ShadowChoice& choice);

/// "none", "hard", "field", "csm" or "traced"
const char* shadowName(ShadowChoice choice);

} // namespace brickfield
