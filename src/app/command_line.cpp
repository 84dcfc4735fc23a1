// One list of commands. A command's flags are parsed first, whole; its action runs afterwards.
#include "app/command_line.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/command_bake.h"
#include "app/command_bench.h"
#include "app/command_compare.h"
#include "app/command_inspect.h"
#include "app/command_list.h"
#include "app/command_mesh.h"
#include "app/command_reference.h"
#include "app/command_render.h"
#include "app/session.h"
#include "core/error.h"

namespace brickfield {

namespace {

void addCommands(CLI::App& program, CommandAction& chosen) {
  addRenderCommand(program, chosen);
  addListCommand(program, chosen);
  addInspectCommand(program, chosen);
  addMeshCommand(program, chosen);
  addBenchCommand(program, chosen);
#ifdef BRICKFIELD_BAKERS
  addBakeCommand(program, chosen);
  addReferenceCommand(program, chosen);
  addCompareCommand(program, chosen);
#endif
}

/// CLI11 would say "not expected" without the names that are.
void checkCommand(CLI::App& program, const std::vector<std::string>& arguments) {
  if (arguments.empty()) throw BadInput("no command is given; \"brickfield --help\" lists them");
  const std::string& first = arguments.front();
  if (!first.empty() && first[0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), first) != names.end()) return;
#ifndef BRICKFIELD_BAKERS
  for (const char* absent : {"bake", "reference", "compare"})
    if (first == absent) throw BadInput(first, "", "this build has neither Embree nor OpenImageIO");
#endif
  throw BadInput(fmt::format("\"{}\"", first), "", fmt::format("is no command; there are {}", fmt::join(names, ", ")));
}

/// CLI11 collects what it does not know in an order of its own.
std::string firstOf(const std::vector<std::string>& unknown, const std::vector<std::string>& arguments) {
  const auto first = std::find_first_of(arguments.begin(), arguments.end(), unknown.begin(), unknown.end());
  return first == arguments.end() ? "an argument" : "\"" + *first + "\"";
}

/// Where a command or one of its own is meant: "render", "list cameras".
std::string commandNamed(const CLI::App& program) {
  std::string name;
  for (const CLI::App* at = &program; !at->get_subcommands().empty();
       name += (name.empty() ? "" : " ") + at->get_name())
    at = at->get_subcommands().front();
  return name;
}

/// CLI11 speaks of counts; a reader wants to know what to do. Its text begins with the option's name.
BadInput refuseCount(const std::string& command, const CLI::ArgumentMismatch& error) {
  const std::string text = error.what();
  const std::string option = text.substr(0, text.find(':'));
  return BadInput(command, option,
                  text.ends_with("missing") ? "needs a value; see --help"
                                            : "may be given once and with one value only");
}

int parseAndRun(std::vector<std::string> arguments) {
  CLI::App program("Renders glTF scenes in which any node may be a signed distance field.", "brickfield");
  program.set_version_flag("--version", "brickfield " BRICKFIELD_VERSION);
  CommandAction chosen;
  addCommands(program, chosen);
  checkCommand(program, arguments);
  const std::vector<std::string> words = arguments;
  try {
    std::reverse(arguments.begin(), arguments.end()); // as CLI11 wants them
    program.parse(std::move(arguments));
  } catch (const CLI::Success& request) { // help, version
    return program.exit(request);
  } catch (const CLI::ArgumentMismatch& error) {
    throw refuseCount(commandNamed(program), error);
  } catch (const CLI::ParseError& error) {
    // A flag that is written wrong often is the one that is missed.
    const std::vector<std::string> unknown = program.remaining(true);
    const std::string command = commandNamed(program);
    if (unknown.empty()) throw BadInput(command, "", error.what());
    if (command.empty()) throw BadInput(firstOf(unknown, words), "", "is not expected before a command; see --help");
    throw BadInput(command, firstOf(unknown, words), "is not expected here; see --help");
  }
  if (!chosen) throw BadInput("no command is given; \"brickfield --help\" lists them");
  return chosen();
}

} // namespace

int runCommandLine(std::vector<std::string> arguments) {
  try {
    const int exitCode = parseAndRun(std::move(arguments));
    if (std::fflush(stdout) != 0)
      throw Failure(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
    return exitCode;
  } catch (const BadInput& error) {
    printError(error.what());
    return kBadInput;
  } catch (const Cancelled& error) {
    printError(error.what());
    return interruptedExitCode();
  } catch (const std::bad_alloc&) {
    printError("out of memory");
  } catch (const std::exception& error) {
    printError(error.what());
  }
  return kOurFailure;
}

} // namespace brickfield
