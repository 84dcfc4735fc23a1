// The flag --shadows, which render and reference share.
#pragma once

#include <set>
#include <string>

#include "passes/light/shadow_maps.h"
#include "passes/light/shadow_settings.h"

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

/// What `--shadows` can be told. Traced from whole lights, Hard from their centres: by the reference. Field: by the
/// renderer, marching the world field. Csm: by shadow maps. CsmField: marched where the maps are unsure.
enum class ShadowChoice { Traced, Hard, Field, Csm, CsmField, None };

/// --shadows of render: field, csm, csm+field or none, which is its default.
/// error  BadInput at parsing: any other word
void addRenderShadows(CLI::App& command, ShadowChoice& choice);
struct ShadowMapChoice {
  ShadowMapSettings settings;
  std::set<std::string> given; ///< flags of this group
};
/// --shadow-filter --shadow-size
void addShadowMapOptions(CLI::App& command, ShadowMapChoice& choice);
/// error BadInput: a flag of this group where these shadows have no maps, or do not filter them
void checkShadowMapChoice(const ShadowMapChoice& choice, ShadowChoice shadows);
const char* shadowFilterName(ShadowFilter filter);

/// --shadows of reference: none; hard, from the lights' centres; or any of render's other words, for all of which it
/// traces exact ones from whole lights; these are its default.
void addReferenceShadows(CLI::App& command, ShadowChoice& choice);

/// As it is told, or "traced".
const char* shadowName(ShadowChoice choice);
/// The renderer's method; None for what the reference alone knows.
ShadowMethod shadowMethodOf(ShadowChoice choice);

} // namespace brickfield
