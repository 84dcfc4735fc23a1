// The flag --shadows, which render and reference share.
#pragma once

#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

/// What `--shadows` can be told. Traced from whole lights, Hard from their centres: by the reference. Field: by the
/// renderer, marching the world field. Csm and its union with Field are refused until the renderer has them.
enum class ShadowChoice { Traced, Hard, Field, None };

/// --shadows of render: field or none, which is its default.
/// error  BadInput at parsing: csm or csm+field, which the renderer does not have yet; any other word
void addRenderShadows(CLI::App& command, ShadowChoice& choice);

/// --shadows of reference: none; hard, from the lights' centres; or any of render's other words, for all of which it
/// traces exact ones from whole lights; these are its default.
void addReferenceShadows(CLI::App& command, ShadowChoice& choice);

/// "none", "hard", "field" or "traced"
const char* shadowName(ShadowChoice choice);

} // namespace brickfield
