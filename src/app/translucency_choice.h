// The flags of translucency.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "passes/light/translucency_settings.h"

namespace CLI {
class App;
} // namespace CLI

namespace brickfield {

struct TranslucencyChoice {
  TranslucencySettings settings;
  std::optional<float> wrap;
};

/// --translucency --translucency-wrap of render.
/// error  BadInput at parsing
void addTranslucencyOptions(CLI::App& command, TranslucencyChoice& choice);

/// Checks the flags against each other, and settles the wrap.
/// error  BadInput that names the flag: --translucency-wrap or --view thickness without --translucency
void settleTranslucencyChoice(TranslucencyChoice& choice, const std::string& view);

/// "off", "on" or "SHARE:R,G,B". error BadInput that names the flag
TranslucencySettings parseTranslucency(const std::string& flag, std::string_view text);

/// What was asked for, as --translucency takes it.
std::string translucencyText(const TranslucencySettings& settings);

} // namespace brickfield
