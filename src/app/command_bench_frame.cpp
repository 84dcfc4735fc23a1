// The flags of render, and what is measured.
#include "app/command_bench_frame.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/bench_frame.h"
#include "app/command_render.h"
#include "core/error.h"

namespace brickfield {

void addFrameBench(CLI::App& bench, CommandAction& chosen) {
  CLI::App& command =
      *bench.add_subcommand("frame", "A whole frame by passes, as render draws it with the same flags; --frames are "
                                     "timed, 60 by default");
  const auto request = std::make_shared<FrameBenchRequest>();
  request->render.frames = kBenchedFrames;
  addFrameOptions(command, request->render);
  addValue(command, "--beside", "Published figures to print beside: thesis, of its scene (brickfield_scenes thesis)",
           [=](auto& flag, auto& text) {
             if (text != "thesis") throw BadInput(flag, fmt::format("\"{}\"", text), "is not thesis");
             request->besideThesis = true;
           })
      ->type_name("WHAT");
  addPath(command, "--json", "The figures as .json", request->json);
  command.callback([request, &chosen] {
    chosen = [request] {
      runFrameBench(*request);
      return 0;
    };
  });
}

} // namespace brickfield
