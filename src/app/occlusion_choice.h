// The flags of ambient occlusion. --ao-radius is the same for render and reference.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "passes/light/occlusion_settings.h"

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace brickfield {

struct OcclusionChoice {
  OcclusionSettings settings;
  std::optional<float> radiusMetres;
  bool hasScale = false;
};

/// --ao --ao-radius --ao-scale of render.
/// error  BadInput at parsing
void addOcclusionOptions(CLI::App& command, OcclusionChoice& choice);

/// Checks the flags against each other, and settles the radius.
/// error  BadInput that names the flag: --ao-radius or --ao-scale without --ao; 5tap or rays without a radius; beside
/// --world-field off; --view ao without --ao
void settleOcclusionChoice(OcclusionChoice& choice, const std::string& view, bool hasWorldField);

/// --ao-radius: metres above 0; what is farther away occludes nothing.
CLI::Option* addOcclusionRadius(CLI::App& command, std::optional<float>& radiusMetres);

/// error BadInput that names the flag
OcclusionForm parseOcclusionForm(const std::string& flag, std::string_view text);
/// "full", "half", "quarter". error BadInput that names the flag
int parseOcclusionScale(const std::string& flag, std::string_view text);

} // namespace brickfield
