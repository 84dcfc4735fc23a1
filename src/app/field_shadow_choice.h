// The flags of `render` that shape shadows from the world field.
#pragma once

#include <set>
#include <string>

#include "passes/light/shadow_settings.h"

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

/// Rays unless --shadow-rays says otherwise: fewer than the renderer's own default, whose steps neighbours need not
/// hide.
inline constexpr int kChosenRays = 10;

struct FieldShadowChoice {
  FieldShadowChoice() { settings.penumbraRays = kChosenRays; }

  ShadowSettings settings;
  int brickVoxels = 0;         ///< along the scene's longest side, of bricks that meshes get for light alone; 0: none
  std::set<std::string> given; ///< flags of this group
};

/// --shadow-estimator --shadow-rays --shadow-softness --shadow-resolution --shadow-bricks
/// error  BadInput at parsing: an unknown word, a value out of its range
void addFieldShadowOptions(CLI::App& command, FieldShadowChoice& choice);

/// Checks what flags can be told of each other.
///
/// isMarched  shadows are marched in the world field at all
/// error      BadInput that names the flag: of shadows that are not marched, of another estimator, or of a world field
///            that knows no objects
/// proved by  tests/unit/app/field_shadow_choice_test.cpp
void checkFieldShadowChoice(const FieldShadowChoice& choice, bool isMarched, bool isExactField);

ShadowEstimator parseEstimator(const std::string& flag, const std::string& text);
const char* estimatorName(ShadowEstimator estimator);

} // namespace brickfield
