// brickfield_scenes: writes the project's own scenes as .glb files.
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/core.h>

#include "core/error.h"
#include "core/files.h"
#include "scenes/scenes.h"

namespace {

using brickfield::BadInput;

constexpr const char* kUsage = "usage: brickfield_scenes demo -o OUT.glb\n"
                               "       brickfield_scenes interpenetration -o OUT.glb\n"
                               "       brickfield_scenes stress [--count N] [--seed S] -o OUT.glb\n"
                               "       brickfield_scenes thesis [--count N] -o OUT.glb\n";
constexpr std::uint64_t kMaxCount = 10'000'000;

struct Arguments {
  std::string_view scene;
  std::string_view output;
  std::optional<std::uint64_t> count;
  std::uint64_t seed = 1;
};

std::uint64_t parseNumber(std::string_view flag, std::string_view text, std::uint64_t low, std::uint64_t high) {
  std::uint64_t value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < low || value > high) {
    throw BadInput(flag, "", fmt::format("\"{}\" is not a whole number from {} to {}", text, low, high));
  }
  return value;
}

Arguments parseArguments(std::span<char*> words) {
  if (words.empty())
    throw BadInput("command line", "", "no scene is named; demo, interpenetration, stress and thesis exist");
  Arguments arguments;
  arguments.scene = words[0];
  bool isStress = arguments.scene == "stress";
  bool isThesis = arguments.scene == "thesis";
  if (!isStress && !isThesis && arguments.scene != "demo" && arguments.scene != "interpenetration") {
    throw BadInput(
        "command line", "",
        fmt::format("unknown scene \"{}\"; demo, interpenetration, stress and thesis exist", arguments.scene));
  }
  for (std::size_t i = 1; i < words.size(); i += 2) {
    std::string_view flag = words[i];
    bool isNumber = (isStress && (flag == "--count" || flag == "--seed")) || (isThesis && flag == "--count");
    if (flag != "-o" && !isNumber) throw BadInput("command line", "", fmt::format("unknown argument \"{}\"", flag));
    if (i + 1 == words.size()) throw BadInput(flag, "", "a value is missing");
    std::string_view value = words[i + 1];
    if (flag == "-o") arguments.output = value;
    if (flag == "--count") arguments.count = parseNumber(flag, value, isThesis ? 3 : 1, isThesis ? 100 : kMaxCount);
    if (flag == "--seed") arguments.seed = parseNumber(flag, value, 0, UINT64_MAX);
  }
  if (arguments.output.empty()) throw BadInput("command line", "", "-o OUT.glb is missing");
  if (!arguments.output.ends_with(".glb")) throw BadInput(arguments.output, "", "the name must end in .glb");
  return arguments;
}

std::vector<std::byte> makeScene(const Arguments& arguments) {
  if (arguments.scene == "demo") return brickfield::scenes::demoScene();
  if (arguments.scene == "interpenetration") return brickfield::scenes::interpenetrationScene();
  if (arguments.scene == "thesis")
    return brickfield::scenes::thesisScene(static_cast<int>(arguments.count.value_or(100)));
  return brickfield::scenes::stressScene(static_cast<int>(arguments.count.value_or(1000)), arguments.seed);
}

} // namespace

int main(int argc, char** argv) {
  std::span<char*> words(argv + 1, argc > 0 ? static_cast<std::size_t>(argc - 1) : 0);
  for (std::string_view word : words) {
    if (word == "--help" || word == "-h") {
      std::fputs(kUsage, stdout);
      return 0;
    }
  }
  try {
    Arguments arguments = parseArguments(words);
    brickfield::writeFile(std::filesystem::path(arguments.output), makeScene(arguments));
    return 0;
  } catch (const BadInput& error) {
    fmt::print(stderr, "brickfield_scenes: {}\n", error.what());
    if (words.empty()) std::fputs(kUsage, stderr);
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "brickfield_scenes: {}\n", error.what());
    return 1;
  }
}
