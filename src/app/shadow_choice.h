// The flag --shadows, which render and reference share.
#pragma once

#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

/// What `--shadows` can be told: traced from whole lights, traced from their centres (hard), none. Field and Csm and
/// their union are refused until the renderer has them.
enum class ShadowChoice { Traced, Hard, None };

/// --shadows of render: none, which is its default.
/// error  BadInput at parsing: field, csm or csm+field, which the renderer does not have yet; any other word
void addRenderShadows(CLI::App& command, ShadowChoice& choice);

/// --shadows of reference: none; hard, from the lights' centres; or any of render's other words, for all of which it
/// traces exact ones from whole lights; these are its default.
void addReferenceShadows(CLI::App& command, ShadowChoice& choice);

/// "none", "hard" or "traced"
const char* shadowName(ShadowChoice choice);

} // namespace brickfield
