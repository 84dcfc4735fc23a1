// Words at parsing; what they mean for each other once all are known.
#include "app/translucency_choice.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

TranslucencySettings parseTranslucency(const std::string& flag, std::string_view text) {
  TranslucencySettings settings;
  if (text == "off") return settings;
  settings.source = TranslucencySource::Materials;
  if (text == "on") return settings;
  settings.source = TranslucencySource::Given;
  const std::vector<std::string_view> parts = splitText(text, ':');
  if (parts.size() != 2) throw BadInput(flag, fmt::format("\"{}\"", text), "is none of off, on and SHARE:R,G,B");
  settings.share = static_cast<float>(parseNumber(flag, parts[0], 0, 1));
  settings.absorption = parseVector(flag, parts[1]);
  for (int c = 0; c < 3; ++c)
    if (settings.absorption[c] < 0)
      throw BadInput(flag, fmt::format("\"{}\"", text), "absorbs less than nothing per metre");
  return settings;
}

std::string translucencyText(const TranslucencySettings& settings) {
  if (settings.source == TranslucencySource::Off) return "off";
  if (settings.source == TranslucencySource::Materials) return "on";
  const glm::vec3& absorption = settings.absorption;
  return fmt::format("{}:{},{},{}", settings.share, absorption.x, absorption.y, absorption.z);
}

void addTranslucencyOptions(CLI::App& command, TranslucencyChoice& choice) {
  addValue(
      command, "--translucency",
      "Light through SDF objects, dimmed by the way through their bricks: off (the default); on, as "
      "KHR_materials_diffuse_transmission and KHR_materials_volume of their first material say; or SHARE:R,G,B for "
      "all of them: the share of diffuse light that passes, what is absorbed per metre",
      [&](auto& flag, auto& text) { choice.settings = parseTranslucency(flag, text); })
      ->type_name("WHAT");
  addValue(command, "--translucency-wrap", "How far that light reaches round to the front, 0 (the default) to 1",
           [&](auto& flag, auto& text) { choice.wrap = static_cast<float>(parseNumber(flag, text, 0, 1)); })
      ->type_name("W");
}

void settleTranslucencyChoice(TranslucencyChoice& choice, const std::string& view) {
  if (choice.settings.source == TranslucencySource::Off) {
    if (choice.wrap) throw BadInput("--translucency-wrap", "", "needs --translucency");
    if (view == "thickness") throw BadInput("--view", view, "needs --translucency, which finds it");
  }
  choice.settings.wrap = choice.wrap.value_or(0.0f);
}

} // namespace brickfield
