// The flags of reflections.
#pragma once

#include <string>

#include "passes/light/reflection_settings.h"

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

struct ReflectionChoice {
  ReflectionSettings settings;
  bool hasScale = false;
};

/// --reflections --reflection-scale of render.
/// error  BadInput at parsing
void addReflectionOptions(CLI::App& command, ReflectionChoice& choice);

/// Checks the flags against each other.
/// error  BadInput that names the flag: --reflection-scale or --view reflection without --reflections; without an exact
/// world field
void checkReflectionChoice(const ReflectionChoice& choice, const std::string& view, bool hasExactField);

} // namespace brickfield
