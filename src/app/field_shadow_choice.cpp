// Words and ranges; what goes together.
#include "app/field_shadow_choice.h"

#include <array>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/options.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

namespace {

// In the order of ShadowEstimator.
constexpr std::array<const char*, 6> kEstimators{"rays", "hard", "min-ratio", "coverage", "rtsdf", "umbra"};

bool takesRays(ShadowEstimator estimator) {
  return estimator == ShadowEstimator::Rays || estimator == ShadowEstimator::Umbra;
}

} // namespace

ShadowEstimator parseEstimator(const std::string& flag, const std::string& text) {
  for (std::size_t i = 0; i < kEstimators.size(); ++i)
    if (text == kEstimators[i]) return static_cast<ShadowEstimator>(i);
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of rays, hard, min-ratio, coverage, rtsdf and umbra");
}

const char* estimatorName(ShadowEstimator estimator) { return kEstimators[static_cast<std::size_t>(estimator)]; }

void addFieldShadowOptions(CLI::App& command, FieldShadowChoice& choice) {
  const auto add = [&](const char* name, const std::string& help, const char* type, auto take) {
    addValue(command, name, help, [&choice, take](auto& flag, auto& text) {
      choice.given.insert(flag);
      take(choice, flag, text);
    })->type_name(type);
  };
  using Text = const std::string&;
  add("--shadow-estimator",
      "How --shadows field marches: rays (our own, the default), or for comparison hard, min-ratio (Quilez, the "
      "thesis), "
      "coverage, rtsdf or umbra (both Tan and others 2022)",
      "NAME", [](FieldShadowChoice& c, Text flag, Text text) { c.settings.estimator = parseEstimator(flag, text); });
  add("--shadow-rays", "Rays to a light of which a part is seen, 1 to 64, 10 by default; of rays and umbra", "N",
      [](FieldShadowChoice& c, Text flag, Text text) {
        c.settings.penumbraRays = static_cast<int>(parseWhole(flag, text, 1, 64));
      });
  add("--shadow-softness", "Of the fade between rays, 0 to 4: 1, the default, as wide as they are apart", "S",
      [](FieldShadowChoice& c, Text flag, Text text) {
        c.settings.softness = static_cast<float>(parseNumber(flag, text, 0, 4));
      });
  add("--shadow-resolution", "full, the default, or half: every fourth pixel first, others from those on their plane",
      "SIZE", [](FieldShadowChoice& c, Text flag, Text text) {
        if (text != "full" && text != "half")
          throw BadInput(flag, fmt::format("\"{}\"", text), "is neither full nor half");
        c.settings.halfResolution = text == "half";
      });
  add("--shadow-bricks",
      "Bricks that make shadows exact beside surfaces: objects (those of SDF objects, the default), off, or N: rigid "
      "meshes get some too, for shadows alone, N voxels along the scene's longest side, 64 to 4096",
      "WHICH", [](FieldShadowChoice& c, Text flag, Text text) {
        c.settings.nearBricks = text != "off";
        c.brickVoxels = text == "off" || text == "objects" ? 0 : static_cast<int>(parseWhole(flag, text, 64, 4096));
      });
}

void checkFieldShadowChoice(const FieldShadowChoice& choice, bool isMarched, bool isExactField) {
  if (choice.given.empty()) return;
  if (!isMarched) throw BadInput(*choice.given.begin(), "", "needs --shadows field");
  const bool isOurs = choice.settings.estimator == ShadowEstimator::Rays;
  const std::string of = fmt::format("is not of --shadow-estimator {}", estimatorName(choice.settings.estimator));
  if (choice.given.contains("--shadow-rays") && !takesRays(choice.settings.estimator))
    throw BadInput("--shadow-rays", "", of);
  for (const char* flag : {"--shadow-softness", "--shadow-bricks"})
    if (choice.given.contains(flag) && !isOurs) throw BadInput(flag, "", of);
  if (choice.given.contains("--shadow-bricks") && choice.settings.nearBricks && !isExactField)
    throw BadInput("--shadow-bricks", "", "needs --world-field exact, whose texels know which object is nearest");
}

} // namespace brickfield
