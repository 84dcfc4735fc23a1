// Values at parsing; what they mean for each other once all are known.
#include "app/field_choice.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/field_error_view.h"
#include "app/options.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

namespace {

using Take = std::function<void(const std::string& flag, const std::string& text)>;

constexpr std::array<const char*, 3> kCascadeFlags{"--field-cascades", "--field-texels", "--field-texel"};
constexpr std::array<const char*, 6> kRtsdfFlags{"--field-rays", "--field-alpha", "--field-mask",
                                                 "--field-beta", "--field-bias",  "--field-brute-force"};
constexpr std::array<const char*, 3> kFloodedFlags{"--field-alpha", "--field-mask", "--field-beta"};
constexpr double kLongest = 1e6; // of lengths: anything; the paper's scene is 2 long

[[noreturn]] void refuse(const std::string& flag, const std::string& text, const std::string& reason) {
  throw BadInput(flag, fmt::format("\"{}\"", text), reason);
}

FieldMethod parseMethod(const std::string& flag, const std::string& text) {
  for (const FieldMethod method : {FieldMethod::Exact, FieldMethod::Rtsdf, FieldMethod::Off})
    if (text == fieldMethodName(method)) return method;
  refuse(flag, text, "is none of exact, rtsdf and off");
}

int parseTexels(const std::string& flag, const std::string& text) {
  const auto texels = static_cast<int>(parseWhole(flag, text, 64, 512));
  if (!std::has_single_bit(static_cast<unsigned>(texels))) refuse(flag, text, "is no power of two");
  return texels;
}

void takeSize(FieldSettings& settings, const std::string& flag, const std::string& text) {
  if (text != "S" && text != "M" && text != "L") refuse(flag, text, "is none of S, M and L");
  setRtsdfSize(settings.rtsdf, text);
  settings.shape = {1, settings.rtsdf.fineSize, 0, true};
}

void takeSlice(FieldSlice& slice, const std::string& flag, const std::string& text) {
  if (text == "auto") {
    slice.axis = 1;
    slice.positionWorld.reset();
    return;
  }
  const std::vector<std::string_view> parts = splitText(text, ':');
  const std::size_t axis = parts[0].size() == 1 ? std::string_view("xyz").find(parts[0]) : std::string_view::npos;
  if (parts.size() != 2 || axis == std::string_view::npos)
    refuse(flag, text, "is neither auto nor x:POS, y:POS, z:POS");
  slice.axis = static_cast<int>(axis);
  slice.positionWorld = parseNumber(flag, parts[1], -1e6, 1e6);
}

void addMethodOptions(FieldChoice& choice, const std::function<CLI::Option*(const char*, const char*, Take)>& add) {
  FieldSettings& field = choice.settings;
  RtsdfSettings& rtsdf = field.rtsdf;
  add("--field-cascades", "Cascades of the exact field, 1 to 8, 4 by default", [&](auto& flag, auto& text) {
    field.shape.cascades = static_cast<int>(parseWhole(flag, text, 1, shared::MOST_CASCADES));
  })->type_name("N");
  add("--field-texels", "Texels along a cascade's side, 64 to 512, a power of two, 128 by default",
      [&](auto& flag, auto& text) { field.shape.texels = parseTexels(flag, text); })
      ->type_name("N");
  add("--field-texel", "Metres of the finest cascade's texels; absent: so that the coarsest covers the scene",
      [&](auto& flag, auto& text) { field.shape.texelSize = parseNumber(flag, text, 1e-6, 1e6); })
      ->type_name("M");
  add("--field-size", "One volume over the scene of 128, 256 or 512 texels, S, M or L; rtsdf is M by default",
      [&](auto& flag, auto& text) { takeSize(field, flag, text); })
      ->type_name("SIZE");
  add("--field-rays", "Rays a texel of rtsdf, 0 to 64, 5 by default", [&](auto& flag, auto& text) {
    rtsdf.raysPerTexel = static_cast<int>(parseWhole(flag, text, 0, 64));
  })->type_name("X");
  add("--field-alpha", "What of rtsdf stays from frame to frame, 0 to 1, 0.95 by default", [&](auto& flag, auto& text) {
    rtsdf.decay = static_cast<float>(parseNumber(flag, text, 0, 1));
  })->type_name("A");
  add("--field-mask", "Coarse distance up to which rtsdf sends rays, of a scene 2 long, or inf; 0.1 by default",
      [&](auto& flag, auto& text) {
        rtsdf.maskWidth = text == "inf" ? std::numeric_limits<float>::infinity()
                                        : static_cast<float>(parseNumber(flag, text, 0, kLongest));
      })
      ->type_name("D");
  add("--field-beta",
      "What rtsdf subtracts from coarse distances, of a scene 2 long; a tenth of a coarse texel by default",
      [&](auto& flag, auto& text) { rtsdf.beta = static_cast<float>(parseNumber(flag, text, 0, kLongest)); })
      ->type_name("B");
  add("--field-bias", "What rtsdf subtracts from the finished field, of a scene 2 long; 0.01 by default",
      [&](auto& flag, auto& text) { rtsdf.bias = static_cast<float>(parseNumber(flag, text, 0, kLongest)); })
      ->type_name("B");
}

template <std::size_t count>
void refuseAny(const FieldChoice& choice, const std::array<const char*, count>& flags, const std::string& reason) {
  for (const char* flag : flags)
    if (choice.given.contains(flag)) throw BadInput(flag, "", reason);
}

void checkMethod(const FieldChoice& choice) {
  const FieldSettings& field = choice.settings;
  if (field.method == FieldMethod::Off)
    for (const std::string& flag : choice.given)
      if (flag.starts_with("--field-")) throw BadInput(flag, "", "has no meaning beside --world-field off");
  if (field.method == FieldMethod::Exact) refuseAny(choice, kRtsdfFlags, "is of --world-field rtsdf alone");
  if (field.method == FieldMethod::Rtsdf)
    refuseAny(choice, kCascadeFlags, "is of --world-field exact; rtsdf has one volume, see --field-size");
  if (choice.given.contains("--field-size"))
    refuseAny(choice, kCascadeFlags, "is of cascades; --field-size asks for one volume");
  if (field.rtsdf.bruteForce) {
    refuseAny(choice, kFloodedFlags, "is of the coarse field, which --field-brute-force has not");
    if (choice.given.contains("--field-size"))
      throw BadInput("--field-size", "", "does not go with --field-brute-force, which is always 400x200x400");
  }
}

void checkShown(const FieldChoice& choice, const std::string& viewName) {
  const DebugView* view = findAnyView(viewName);
  for (const char* flag : {"--slice", "--cascade"})
    if (choice.given.contains(flag) && !(view && view->isSlice))
      throw BadInput(flag, "", "is of the views field, field-id, field-tiles and field-error");
  if (!view || !view->readsField) return;
  const FieldSettings& field = choice.settings;
  if (field.method == FieldMethod::Off)
    throw BadInput("--view", viewName, "shows the world field, which --world-field off leaves out");
  if (view->isExactOnly && field.method != FieldMethod::Exact)
    throw BadInput("--view", viewName, "is of --world-field exact; rtsdf knows nothing of it");
  const int cascades = field.method == FieldMethod::Exact ? field.shape.cascades : 1;
  if (choice.slice.cascade >= cascades)
    throw BadInput("--cascade", std::to_string(choice.slice.cascade),
                   fmt::format("there {} {}, counted from 0", cascades == 1 ? "is" : "are", cascades));
}

} // namespace

const DebugView* findAnyView(const std::string& name) {
  const DebugView* error = fieldErrorView();
  return error && error->name == name ? error : findView(name);
}

void addFieldOptions(CLI::App& command, FieldChoice& choice) {
  const auto add = [&command, &choice](const char* name, const char* help, Take take) {
    return addValue(command, name, help, [&choice, take](auto& flag, auto& text) {
      choice.given.insert(flag);
      take(flag, text);
    });
  };
  add("--world-field", "Distance field of the world where something reads it: exact (default), rtsdf or off",
      [&](auto& flag, auto& text) { choice.settings.method = parseMethod(flag, text); })
      ->type_name("METHOD");
  addMethodOptions(choice, add);
  command.add_flag_callback(
      "--field-brute-force",
      [&choice] {
        choice.given.insert("--field-brute-force");
        choice.settings.rtsdf.bruteForce = true;
      },
      "rtsdf: rays from every texel of 400x200x400, summed up over --frames");
  add("--slice", "Plane of the field views: x:POS, y:POS or z:POS in metres, or auto, level through the scene's middle",
      [&](auto& flag, auto& text) { takeSlice(choice.slice, flag, text); })
      ->type_name("PLANE");
  add("--cascade", "Cascade of the field views, from 0, the finest; or auto, the finest at each point",
      [&](auto& flag, auto& text) {
        choice.slice.cascade =
            text == "auto" ? -1 : static_cast<int>(parseWhole(flag, text, 0, shared::MOST_CASCADES - 1));
      })
      ->type_name("N");
}

void settleFieldChoice(FieldChoice& choice, const std::string& view, std::uint64_t seed) {
  checkMethod(choice);
  checkShown(choice, view);
  choice.settings.rtsdf.seed = static_cast<std::uint32_t>(seed ^ seed >> 32);
}

} // namespace brickfield
