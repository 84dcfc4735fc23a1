// The flags of `bench world-field`, `bench ao` and `bench bake`; those of `bench shadows` are beside.
#include "app/command_bench.h"

#include <bit>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/bench_bake.h"
#include "app/bench_occlusion.h"
#include "app/bench_world_field.h"
#include "app/command_bench_frame.h"
#include "app/command_bench_shadows.h"
#include "app/occlusion_choice.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

namespace {

template <typename Value, typename Parse>
std::vector<Value> parseList(const std::string& text, const Parse& parse) {
  std::vector<Value> values;
  for (const std::string_view piece : splitText(text, ',')) values.push_back(parse(piece));
  return values;
}

std::string parseOf(const std::string& flag, std::string_view text, std::initializer_list<const char*> names) {
  std::string list;
  for (const char* name : names) {
    if (text == name) return name;
    list += fmt::format("{}{}", list.empty() ? "" : ", ", name);
  }
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of " + list);
}

float parseMask(const std::string& flag, std::string_view text) {
  return text == "inf" ? std::numeric_limits<float>::infinity() : static_cast<float>(parseNumber(flag, text, 0, 1e6));
}

std::function<int(std::string_view)> wholeIn(const std::string& flag, int least, int most) {
  return [=](std::string_view text) { return static_cast<int>(parseWhole(flag, text, least, most)); };
}

int parseTexels(const std::string& flag, const std::string& text) {
  const int texels = wholeIn(flag, 64, 512)(text);
  if (!std::has_single_bit(static_cast<unsigned>(texels)))
    throw BadInput(flag, fmt::format("\"{}\"", text), "is no power of two");
  return texels;
}

void addMovers(CLI::App& command, FieldBenchRequest& request) {
  addValue(command, "--movers", "Instead: crowds of as many moving SDF objects, comma separated, such as 1000",
           [&](auto& flag, auto& text) { request.moverCounts = parseList<int>(text, wholeIn(flag, 1, 1000000)); })
      ->type_name("N,...");
  addValue(command, "--field-cascades", "Cascades that the movers are in, 1 to 8, 4 by default",
           [&](auto& flag, auto& text) { request.moverShape.cascades = wholeIn(flag, 1, 8)(text); })
      ->type_name("N");
  addValue(command, "--field-texels", "Texels along those cascades' sides, 64 to 512, a power of two, 128 by default",
           [&](auto& flag, auto& text) { request.moverShape.texels = parseTexels(flag, text); })
      ->type_name("N");
}

void addMeasures(CLI::App& command, FieldBenchRequest& request) {
  addValue(command, "--show", "Of table1, table3, table4 and errors, comma separated; absent: all",
           [&](auto& flag, auto& text) {
             request.shown.clear();
             for (const std::string_view piece : splitText(text, ','))
               request.shown.insert(parseOf(flag, piece, {"table1", "table3", "table4", "errors"}));
           })
      ->type_name("PART,...");
  addValue(command, "--sizes", "Of S, M and L, comma separated; absent: all", [&](auto& flag, auto& text) {
    request.sizes = parseList<std::string>(text, [&](std::string_view piece) {
      return parseOf(flag, piece, {"S", "M", "L"});
    });
  })->type_name("SIZE,...");
  addValue(command, "--rays", "Rays a texel of RTSDF, 0 to 64, comma separated; absent: as in each table",
           [&](auto& flag, auto& text) { request.rays = parseList<int>(text, wholeIn(flag, 0, 64)); })
      ->type_name("X,...");
  addValue(command, "--masks", "Mask widths of table 4, comma separated, or inf; absent: the paper's",
           [&](auto& flag, auto& text) {
             request.masks = parseList<float>(text, [&](std::string_view piece) { return parseMask(flag, piece); });
           })
      ->type_name("D,...");
  addValue(command, "--frames", "Frames that are timed, 30 by default", [&](auto& flag, auto& text) {
    request.frames = wholeIn(flag, 1, 100000)(text);
  })->type_name("N");
}

void addErrors(CLI::App& command, FieldBenchRequest& request) {
  addValue(command, "--error-frames", "Frames after which RTSDF's errors are taken, comma separated; 1,60 by default",
           [&](auto& flag, auto& text) { request.errorFrames = parseList<int>(text, wholeIn(flag, 1, 100000)); })
      ->type_name("N,...");
  addValue(command, "--error-samples", "Most texels that are compared, 2000000 by default",
           [&](auto& flag, auto& text) {
             request.errorSamples = static_cast<std::size_t>(parseWhole(flag, text, 1, std::int64_t{1} << 32));
           })
      ->type_name("N");
}

void addDevice(CLI::App& command, FieldBenchRequest& request) {
  addValue(command, "--bandwidth", "GB/s of the GPU's memory, for the floor; absent: 4800 on an H200, else not known",
           [&](auto& flag, auto& text) { request.bandwidthGigabytes = parseNumber(flag, text, 1e-3, 1e6); })
      ->type_name("GB/S");
  addValue(command, "--tera-operations", "10^12 operations a second, for the floor; absent: 67 on an H200",
           [&](auto& flag, auto& text) { request.teraOperations = parseNumber(flag, text, 1e-3, 1e6); })
      ->type_name("T/S");
  addValue(command, "--device", "EGL device by number", [&](auto& flag, auto& text) {
    request.device = wholeIn(flag, 0, 255)(text);
  })->type_name("N");
  addPath(command, "--json", "The figures as .json", request.json);
}

/// Crowds stand instead of the tables and errors: what shapes the one says nothing to the other.
void separateMovers(CLI::App& command) {
  CLI::Option* movers = command.get_option("--movers");
  for (const char* name : {"--show", "--sizes", "--rays", "--masks", "--error-frames", "--error-samples", "--bandwidth",
                           "--tera-operations"})
    movers->excludes(command.get_option(name));
  for (const char* name : {"--field-cascades", "--field-texels"}) command.get_option(name)->needs(movers);
}

void addWorldField(CLI::App& bench, CommandAction& chosen) {
  CLI::App& command = *bench.add_subcommand(
      "world-field", "The tables of the RTSDF paper, measured for both methods, and their errors");
  const auto request = std::make_shared<FieldBenchRequest>();
  addSceneOptions(command, request->scene);
  addCameraOptions(command, request->camera);
  addMeasures(command, *request);
  addMovers(command, *request);
  addErrors(command, *request);
  addDevice(command, *request);
  separateMovers(command);
  command.callback([request, &chosen] {
    chosen = [request] {
      runFieldBench(*request);
      return 0;
    };
  });
}

float parseRadius(const std::string& flag, std::string_view text) {
  const double metres = text == "inf" ? std::numeric_limits<double>::infinity() : parseNumber(flag, text, 0, 1e12);
  if (!(metres > 0)) throw BadInput(flag, fmt::format("\"{}\"", text), "is not above 0");
  return static_cast<float>(metres);
}

void addOcclusion(CLI::App& bench, CommandAction& chosen) {
  CLI::App& command =
      *bench.add_subcommand("ao", "Ambient occlusion: time, reads and error against the reference of each form");
  const auto request = std::make_shared<OcclusionBenchRequest>();
  command.add_option("SCENES", request->scenes, "glTF 2.0 files")->required();
  addCameraOptions(command, request->camera);
  command.add_option("--sdf", request->sdf.patterns, "Nodes drawn as SDF objects, as for render")
      ->delimiter(',')
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("GLOB");
  addPath(command, "--cache", "Folder of baked bricks", request->cache);
  addFieldOptions(command, request->field);
  addValue(command, "--radii", "As --ao-radius of render, metres or inf, comma separated; 1,inf by default",
           [=](auto& flag, auto& text) {
             request->radii = parseList<float>(text, [&](auto piece) { return parseRadius(flag, piece); });
           })
      ->type_name("M,...");
  addValue(command, "--forms", "As --ao of render, comma separated; absent: all", [=](auto& flag, auto& text) {
    request->forms = parseList<OcclusionForm>(text, [&](auto piece) {
      const OcclusionForm form = parseOcclusionForm(flag, piece);
      if (form == OcclusionForm::Off) throw BadInput(flag, "off", "has nothing to measure");
      return form;
    });
  })->type_name("FORM,...");
  addValue(command, "--scales", "As --ao-scale of render, comma separated; absent: all", [=](auto& flag, auto& text) {
    request->scales = parseList<int>(text, [&](auto piece) { return parseOcclusionScale(flag, piece); });
  })->type_name("SCALE,...");
  addValue(command, "--samples", "Of the reference, a pixel, 64 by default; 0: no errors", [=](auto& flag, auto& text) {
    request->samples = wholeIn(flag, 0, 65536)(text);
  })->type_name("N");
  addValue(command, "--frames", "Frames that are timed, 10 by default", [=](auto& flag, auto& text) {
    request->frames = wholeIn(flag, 1, 100000)(text);
  })->type_name("N");
  addValue(command, "--device", "EGL device by number", [=](auto& flag, auto& text) {
    request->device = wholeIn(flag, 0, 255)(text);
  })->type_name("N");
  addPath(command, "--json", "The figures as .json", request->json);
  command.callback([request, &chosen] {
    chosen = [request] {
      settleFieldChoice(request->field, "", 0);
      if (request->field.settings.method == FieldMethod::Off)
        throw BadInput("--world-field", "off", "leaves nothing to measure");
      runOcclusionBench(*request);
      return 0;
    };
  });
}

#ifdef BRICKFIELD_BAKERS
void addBake(CLI::App& bench, CommandAction& chosen) {
  CLI::App& command = *bench.add_subcommand("bake", "Times, memory and errors of the baker, beside OpenVDB's");
  const auto request = std::make_shared<BakeBenchRequest>();
  command.add_option("FILES", request->meshPaths, "glTF 2.0 files: of each the largest mesh")->required();
  addValue(command, "--resolutions", "Voxels along the longest side, 8 to 1024, comma separated; 64,128,256 by default",
           [=](auto& flag, auto& text) { request->resolutions = parseList<int>(text, wholeIn(flag, 8, 1024)); })
      ->type_name("N,...");
  addValue(command, "--sign", "As for bake; auto by default", [=](auto& flag, auto& text) {
    request->sign = parseSign(flag, text);
  })->type_name("METHOD");
  command.add_flag("--joined", request->isJoined, "All meshes of a file in one, as they stand in its scene");
  addValue(command, "--threads", "Of both sides, 2 by default", [=](auto& flag, auto& text) {
    request->threads = wholeIn(flag, 1, 1024)(text);
  })->type_name("N");
  addValue(command, "--repeats", "Runs of which the median is taken, 5 by default", [=](auto& flag, auto& text) {
    request->repeats = wholeIn(flag, 1, 1000)(text);
  })->type_name("N");
  addValue(command, "--error-samples", "Samples that are compared with brute force; absent: what takes a second or two",
           [=](auto& flag, auto& text) {
             request->errorSamples = static_cast<std::size_t>(parseWhole(flag, text, 1, 100000000));
           })
      ->type_name("N");
  command.add_flag("!--no-full", request->withFullBake, "Leave out the bake with attributes and mips");
  addPath(command, "--json", "The figures as .json", request->json);
  command.callback([request, &chosen] {
    chosen = [request] {
      runBakeBench(*request);
      return 0;
    };
  });
}
#endif

} // namespace

void addBenchCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("bench", "Measure, on this machine");
  command.callback([&command] {
    if (command.get_subcommands().empty()) throw BadInput("bench", "", "needs frame, world-field, shadows, ao or bake");
  });
  addFrameBench(command, chosen);
  addWorldField(command, chosen);
  addShadowBench(command, chosen);
  addOcclusion(command, chosen);
#ifdef BRICKFIELD_BAKERS
  addBake(command, chosen);
#endif
}

} // namespace brickfield
