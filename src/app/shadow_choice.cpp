// One list of words for both commands, so that one set of flags serves them.
#include "app/shadow_choice.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::array<const char*, 3> kRenderedWords{"field", "csm", "csm+field"};

/// True for none, false for a word of the renderer's shadows.
bool isNone(const std::string& flag, const std::string& text) {
  if (text == "none") return true;
  if (std::ranges::find(kRenderedWords, text) != kRenderedWords.end()) return false;
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of field, csm, csm+field and none");
}

} // namespace

void addRenderShadows(CLI::App& command, ShadowChoice& choice) {
  choice = ShadowChoice::None;
  addValue(
      command, "--shadows",
      "Shadows of the first four lights: field (soft, by marching the world field), csm (shadow maps: four cascades "
      "for suns, one map for spots, six for all others), csm+field (marched where the maps do not know, and for suns "
      "up to "
      "a degree by the maps alone), or none, the default",
      [&](auto& flag, auto& text) {
        if (isNone(flag, text))
          choice = ShadowChoice::None;
        else
          choice = text == "csm" ? ShadowChoice::Csm : text == "field" ? ShadowChoice::Field : ShadowChoice::CsmField;
      })
      ->type_name("KIND");
}

void addShadowMapOptions(CLI::App& command, ShadowMapChoice& choice) {
  addValue(command, "--shadow-filter",
           "How shadow maps are filtered: pcf (three texels a side, the default) or evsm (moments, blurred over 15)",
           [&](auto& flag, auto& text) {
             if (text != "pcf" && text != "evsm")
               throw BadInput(flag, fmt::format("\"{}\"", text), "is neither pcf nor evsm");
             choice.given.insert(flag);
             choice.settings.filter = text == "evsm" ? ShadowFilter::Evsm : ShadowFilter::Pcf;
           })
      ->type_name("FILTER");
  addValue(command, "--shadow-size", fmt::format("Texels of a shadow map's side, {} by default", choice.settings.size),
           [&](auto& flag, auto& text) {
             choice.given.insert(flag);
             choice.settings.size = static_cast<int>(parseWhole(flag, text, kLeastShadowTexels, kMostShadowTexels));
           })
      ->type_name("N");
}

void checkShadowMapChoice(const ShadowMapChoice& choice, ShadowChoice shadows) {
  if (choice.given.empty()) return;
  if (!drawsMaps(shadowMethodOf(shadows)))
    throw BadInput(*choice.given.begin(), "", "needs --shadows csm or csm+field");
  if (choice.given.contains("--shadow-filter") && shadows != ShadowChoice::Csm)
    throw BadInput("--shadow-filter", "", "is of --shadows csm: csm+field filters nothing");
}

const char* shadowFilterName(ShadowFilter filter) { return filter == ShadowFilter::Evsm ? "evsm" : "pcf"; }

void addReferenceShadows(CLI::App& command, ShadowChoice& choice) {
  choice = ShadowChoice::Traced;
  addValue(
      command, "--shadows",
      "none and hard take every light for a point; none lets it through everything; a kind that render takes "
      "(field, csm, csm+field) means here exact ones of whole lights, the default",
      [&](auto& flag, auto& text) {
        choice = text == "hard" ? ShadowChoice::Hard : isNone(flag, text) ? ShadowChoice::None : ShadowChoice::Traced;
      })
      ->type_name("KIND");
}

const char* shadowName(ShadowChoice choice) {
  switch (choice) {
  case ShadowChoice::None:
    return "none";
  case ShadowChoice::Hard:
    return "hard";
  case ShadowChoice::Field:
    return "field";
  case ShadowChoice::Csm:
    return "csm";
  case ShadowChoice::CsmField:
    return "csm+field";
  case ShadowChoice::Traced:
    return "traced";
  }
  return "unknown";
}

ShadowMethod shadowMethodOf(ShadowChoice choice) {
  if (choice == ShadowChoice::Field) return ShadowMethod::Field;
  if (choice == ShadowChoice::Csm) return ShadowMethod::Maps;
  return choice == ShadowChoice::CsmField ? ShadowMethod::MapsAndField : ShadowMethod::None;
}

} // namespace brickfield
