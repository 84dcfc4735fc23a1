// Words at parsing; what they mean for each other once all are known.
#include "app/occlusion_choice.h"

#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

OcclusionForm parseOcclusionForm(const std::string& flag, std::string_view text) {
  for (const OcclusionForm form : {OcclusionForm::Taps, OcclusionForm::Rays, OcclusionForm::Cones, OcclusionForm::Off})
    if (text == occlusionFormName(form)) return form;
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of 5tap, rays, cones and off");
}

int parseOcclusionScale(const std::string& flag, std::string_view text) {
  constexpr std::array<std::pair<std::string_view, int>, 3> kScales{{{"full", 1}, {"half", 2}, {"quarter", 4}}};
  for (const auto& [name, scale] : kScales)
    if (text == name) return scale;
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of full, half and quarter");
}

CLI::Option* addOcclusionRadius(CLI::App& command, std::optional<float>& radiusMetres) {
  return addValue(command, "--ao-radius",
                  "What is farther away occludes nothing, metres; absent: however far; with --ao",
                  [&](auto& flag, auto& text) {
                    const double metres = parseNumber(flag, text, 0, 1e12);
                    if (!(metres > 0)) throw BadInput(flag, text, "is not above 0");
                    radiusMetres = static_cast<float>(metres);
                  })
      ->type_name("M");
}

void addOcclusionOptions(CLI::App& command, OcclusionChoice& choice) {
  addValue(command, "--ao",
           "Ambient occlusion from the world field: cones (traced), 5tap (along the normal) or rays (five times that), "
           "both with --ao-radius; or off, the default",
           [&](auto& flag, auto& text) { choice.settings.form = parseOcclusionForm(flag, text); })
      ->type_name("FORM");
  addOcclusionRadius(command, choice.radiusMetres);
  addValue(command, "--ao-scale", "Where it is traced: at full, half (default) or quarter resolution",
           [&](auto& flag, auto& text) {
             choice.settings.scale = parseOcclusionScale(flag, text);
             choice.hasScale = true;
           })
      ->type_name("SCALE");
}

void settleOcclusionChoice(OcclusionChoice& choice, const std::string& view, bool hasWorldField) {
  const char* name = occlusionFormName(choice.settings.form);
  if (choice.settings.form == OcclusionForm::Off) {
    if (choice.radiusMetres) throw BadInput("--ao-radius", "", "needs --ao");
    if (choice.hasScale) throw BadInput("--ao-scale", "", "needs --ao");
    if (view == "ao") throw BadInput("--view", view, "shows ambient occlusion and needs --ao");
    return;
  }
  if (!hasWorldField) throw BadInput("--ao", name, "needs a world field, which --world-field off leaves out");
  if (choice.settings.form != OcclusionForm::Cones && !choice.radiusMetres)
    throw BadInput("--ao", name, "spreads its taps over --ao-radius, which is not given");
  if (choice.radiusMetres) choice.settings.radiusMetres = *choice.radiusMetres;
}

} // namespace brickfield
