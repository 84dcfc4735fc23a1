// One list of words for both commands, so that one set of flags serves them.
#include "app/shadow_choice.h"

#include <algorithm>
#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options.h"
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
  addValue(command, "--shadows",
           "Shadows of the first four lights: field (soft, by marching the world field), or none, the default",
           [&](auto& flag, auto& text) {
             const bool none = isNone(flag, text);
             if (!none && text != "field")
               throw BadInput(flag, fmt::format("\"{}\"", text), "is not drawn by this version; field and none are");
             choice = none ? ShadowChoice::None : ShadowChoice::Field;
           })
      ->type_name("KIND");
}

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
  case ShadowChoice::Traced:
    return "traced";
  }
  return "unknown";
}

} // namespace brickfield
