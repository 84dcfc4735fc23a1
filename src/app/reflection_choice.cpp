// Words at parsing; what they mean for each other once all are known.
#include "app/reflection_choice.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/occlusion_choice.h"
#include "app/options.h"
#include "core/error.h"

namespace brickfield {

void addReflectionOptions(CLI::App& command, ReflectionChoice& choice) {
  addValue(
      command, "--reflections",
      "What smooth surfaces mirror: field, traced in the world field and in bricks; or off, the surroundings alone, "
      "the default",
      [&](auto& flag, auto& text) {
        if (text != "field" && text != "off")
          throw BadInput(flag, fmt::format("\"{}\"", text), "is neither field nor off");
        choice.settings.method = text == "field" ? ReflectionMethod::Field : ReflectionMethod::Off;
      })
      ->type_name("METHOD");
  addValue(command, "--reflection-scale", "Where they are traced: at full, half (default) or quarter resolution",
           [&](auto& flag, auto& text) {
             choice.settings.scale = parseOcclusionScale(flag, text);
             choice.hasScale = true;
           })
      ->type_name("SCALE");
}

void checkReflectionChoice(const ReflectionChoice& choice, const std::string& view, bool hasExactField) {
  if (choice.settings.method == ReflectionMethod::Off) {
    if (choice.hasScale) throw BadInput("--reflection-scale", "", "needs --reflections field");
    if (view == "reflection") throw BadInput("--view", view, "needs --reflections field");
    return;
  }
  if (!hasExactField) throw BadInput("--reflections", "field", "needs --world-field exact, which knows who is nearest");
}

} // namespace brickfield
