// Like with like: two .png by their stored values, two .exr by every layer that both have.
#ifdef BRICKFIELD_BAKERS
#include "app/command_compare.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/command_line.h"
#include "app/compare.h"
#include "app/image_io.h"
#include "app/options.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

struct CompareOptions {
  fs::path a;
  fs::path b;
  fs::path heatmap;
  std::vector<std::string> layers;
  Metric metric = Metric::Rmse;
  std::optional<double> tolerance;
  double unmatchedShare = 0;
};

/// Colour without alpha; a single unnamed part is the colour, as a picture of `render -o x.exr` is.
std::vector<ImagePart> readParts(const fs::path& path) {
  if (extensionOf(path) == ".png") {
    const RgbImage image = readPng(path);
    ImagePart part{"color", image.size, {"R", "G", "B"}, {}};
    for (const glm::vec3& pixel : image.pixels) part.values.insert(part.values.end(), {pixel.x, pixel.y, pixel.z});
    return {part};
  }
  std::vector<ImagePart> parts = readExrParts(path);
  if (parts.size() == 1 && parts[0].name.empty()) parts[0].name = "color";
  return parts;
}

std::string namesOf(const std::vector<ImagePart>& parts) {
  std::vector<std::string> names;
  for (const ImagePart& part : parts) names.push_back(part.name);
  return fmt::format("{}", fmt::join(names, " "));
}

const ImagePart* partNamed(const std::vector<ImagePart>& parts, const std::string& name) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const ImagePart& part) { return part.name == name; });
  return found == parts.end() ? nullptr : &*found;
}

/// Names to compare, in the order of A's parts, color first.
std::vector<std::string> commonLayers(const CompareOptions& options, const std::vector<ImagePart>& a,
                                      const std::vector<ImagePart>& b) {
  for (const std::string& layer : options.layers)
    for (const auto& [path, parts] : {std::pair(options.a, &a), std::pair(options.b, &b)})
      if (!partNamed(*parts, layer))
        throw BadInput(path.string(), "layer " + layer, "is not there; there are " + namesOf(*parts));
  if (!options.layers.empty()) return options.layers;
  std::vector<std::string> names;
  for (const ImagePart& part : a)
    if (partNamed(b, part.name)) names.push_back(part.name);
  if (names.empty())
    throw BadInput(options.b.string(), "",
                   fmt::format("has no layer of {}: {}; {}", options.a.string(), namesOf(a), namesOf(b)));
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name == "color"; });
  return names;
}

/// `steps` tells what a ray cost, not what it met: the reference has none, so it counts only where it is asked for.
bool isWithin(const CompareOptions& options, const LayerDifference& difference) {
  if (difference.layer == "steps" && options.layers.empty()) return true;
  const double unmatched = static_cast<double>(difference.unmatched) / static_cast<double>(difference.pixels);
  return difference.figure <= *options.tolerance && unmatched <= options.unmatchedShare;
}

void print(const LayerDifference& difference, Metric metric) {
  fmt::print("{}: {} {:.6g}, mean {:.6g}, max {:.6g} at {},{}, unmatched {} of {} pixels\n", difference.layer,
             difference.isCategorical ? "share that differs" : metricName(metric), difference.figure,
             difference.meanAbsolute, difference.maxAbsolute, difference.worstPixel.x, difference.worstPixel.y,
             difference.unmatched, difference.pixels);
}

int compare(const CompareOptions& options) {
  checkOutputs({{"--heatmap", options.heatmap, {".png"}}}, {options.a, options.b});
  checkInputPath(options.a, {".png", ".exr"});
  checkInputPath(options.b, {".png", ".exr"});
  if (extensionOf(options.a) != extensionOf(options.b))
    throw BadInput(options.b.string(), "", "8-bit display values and linear radiance cannot be compared");
  const std::vector<ImagePart> a = readParts(options.a), b = readParts(options.b);
  bool isWithinAll = true;
  bool isFirst = true;
  for (const std::string& layer : commonLayers(options, a, b)) {
    const ImagePart& partA = *partNamed(a, layer);
    LayerDifference difference;
    try {
      difference = compareParts(partA, *partNamed(b, layer), options.metric);
    } catch (const BadInput& error) {
      throw BadInput(options.b.string(), "", error.what());
    }
    print(difference, options.metric);
    if (isFirst && !options.heatmap.empty()) writePng(options.heatmap, heatmapOf(difference, partA.size));
    isFirst = false;
    isWithinAll = isWithinAll && (!options.tolerance || isWithin(options, difference));
  }
  if (options.tolerance) fmt::print("{}\n", isWithinAll ? "within tolerance" : "over tolerance");
  return isWithinAll ? kDone : kOurFailure;
}

void addOptions(CLI::App& command, CompareOptions& options) {
  addPath(command, "A", "What is judged: .png or .exr", options.a)->required();
  addPath(command, "B", "The truth: of the same kind and size", options.b)->required();
  addValue(command, "--metric", "rmse (default), mae or relmse; layers id and kind count pixels that differ instead",
           [&](auto& flag, auto& text) { options.metric = parseMetric(flag, text); })
      ->type_name("METRIC");
  addValue(command, "--tolerance",
           "Exit code 1 where the figure of a compared layer is larger; steps count only where --layer names them",
           [&](auto& flag, auto& text) { options.tolerance = parseNumber(flag, text, 0, 1e30); })
      ->type_name("T");
  addValue(command, "--unmatched",
           "Share of pixels, 0 to 1, that may be finite in one file only before the tolerance "
           "counts as missed; 0 by default",
           [&](auto& flag, auto& text) { options.unmatchedShare = parseNumber(flag, text, 0, 1); })
      ->type_name("SHARE");
  command
      .add_option("--layer", options.layers, "Compare only this layer (repeatable); absent: all that both files have")
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("NAME");
  addPath(command, "--heatmap", "Errors of the first compared layer as .png, white at the greatest, green unmatched",
          options.heatmap);
  command.footer("Exit codes: 0 within the tolerance or none given, 1 over it, 2 files that cannot be compared.");
}

} // namespace

void addCompareCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("compare", "Say how far two pictures are apart");
  const auto options = std::make_shared<CompareOptions>();
  addOptions(command, *options);
  command.callback([options, &chosen] { chosen = [options] { return compare(*options); }; });
}

} // namespace brickfield
#endif
