// Groups of flags on CLI11, and how node extras and flags meet.
#include "app/options.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fnmatch.h>

#include "app/environment_io.h"
#include "app/image_io.h"
#include "app/memory_limit.h"
#include "app/parse.h"
#include "core/error.h"
#include "core/files.h"

namespace brickfield {

namespace fs = std::filesystem;

CLI::Option* addValue(CLI::App& command, const std::string& flag, const std::string& help,
                      std::function<void(const std::string&, const std::string&)> take) {
  return command.add_option_function<std::string>(
      flag, [flag, take](const std::string& text) { take(flag, text); }, help);
}

CLI::Option* addPath(CLI::App& command, const std::string& flag, const std::string& help, fs::path& path) {
  return addValue(command, flag, help,
                  [&path](const std::string& name, const std::string& text) {
                    if (text.empty()) throw BadInput(name, "", "names no file");
                    if (text[0] == '=')
                      throw BadInput(name, text,
                                     "takes its file after a blank; of one that begins with =, write ./" + text);
                    path = text;
                  })
      ->type_name("FILE");
}

CLI::Option* addName(CLI::App& command, const std::string& flag, const std::string& help, std::string& name) {
  return addValue(command, flag, help,
                  [&name](const std::string& given, const std::string& text) {
                    if (text.empty()) throw BadInput(given, "", "names nothing");
                    name = text;
                  })
      ->type_name("NAME");
}

void addSceneOptions(CLI::App& command, SceneRequest& request) {
  addPath(command, "SCENE", "glTF 2.0 file (.gltf or .glb)", request.path)->required();
  addValue(command, "--time", "Moment of the animations in seconds; absent: the rest pose",
           [&](auto& flag, auto& text) { request.pose.seconds = parseNumber(flag, text, -1e6, 1e6); })
      ->type_name("S");
  addName(command, "--animation", "Which animations play: NAME, N or all", request.pose.animation);
  command
      .add_option("--sdf", request.sdf.patterns,
                  "Nodes drawn as SDF objects: glob of node names (repeatable, or comma separated), all, or none; "
                  "absent: as the scene's extras say")
      ->delimiter(',')
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("GLOB");
  addValue(command, "--resolution", "Voxels along the longest side of every SDF object, 8 to 1024; wins over extras",
           [&](auto& flag, auto& text) { request.sdf.resolution = static_cast<int>(parseWhole(flag, text, 8, 1024)); })
      ->type_name("N");
  addValue(command, "--triplanar",
           "SDF objects take the textures of their mesh's first material, projected along the axes of object space and "
           "repeated every so many metres of it, in place of baked attributes; wins over extras",
           [&](auto& flag, auto& text) {
             const double metres = parseNumber(flag, text, 0, 1e12);
             if (!(metres > 0)) throw BadInput(flag, text, "is not above 0");
             request.sdf.triplanarMetres = static_cast<float>(metres);
           })
      ->type_name("M");
  addMemoryOption(command, request.sdf);
  addValue(command, "--cache", "Folder of baked bricks; absent: the user's cache folder", [&](auto& flag, auto& text) {
    if (text.empty()) throw BadInput(flag, "", "names no folder");
    request.cacheFolder = text;
  })->type_name("DIR");
  addValue(command, "--threads", "Threads of the CPU's work; 0: all", [&](auto& flag, auto& text) {
    request.threads = static_cast<int>(parseWhole(flag, text, 0, 1024));
  })->type_name("N");
  addValue(command, "--seed", "Seed of everything random", [&](auto& flag, auto& text) {
    request.seed = static_cast<std::uint64_t>(parseWhole(flag, text, 0, std::numeric_limits<std::int64_t>::max()));
  })->type_name("N");
}

void addMemoryOption(CLI::App& command, SdfRequest& request) {
  addValue(command, "--memory", "What a bake may take, such as 1.5GiB or 800MiB; by default most of the machine's",
           [&](auto& flag, auto& text) { request.memoryBytes = parseMemory(flag, text); })
      ->type_name("SIZE");
}

void addCameraOptions(CLI::App& command, CameraRequest& request) {
  addValue(command, "--size",
           fmt::format("Image size in pixels, {}x{} by default", request.sizePixels.x, request.sizePixels.y),
           [&](auto& flag, auto& text) { request.sizePixels = parseSize(flag, text); })
      ->type_name("WxH");
  addName(command, "--camera", "Camera by name or number, or auto, which frames the scene", request.camera);
  addValue(command, "--eye", "Where the camera stands, metres; with --target; the lens stays that of --camera",
           [&](auto& flag, auto& text) { request.eye = parseVector(flag, text); })
      ->type_name("X,Y,Z");
  addValue(command, "--target", "What the camera looks at, metres; with --eye", [&](auto& flag, auto& text) {
    request.target = parseVector(flag, text);
  })->type_name("X,Y,Z");
  addValue(command, "--fov", "Vertical field of view in degrees", [&](auto& flag, auto& text) {
    request.verticalFovDegrees = static_cast<float>(parseNumber(flag, text, 0.01, 179.0));
  })->type_name("DEG");
}

void checkCamera(const CameraRequest& request) {
  if (request.eye && !request.target) throw BadInput("--eye", "", "needs --target");
  if (request.target && !request.eye) throw BadInput("--target", "", "needs --eye");
  if (request.eye && request.camera == "auto")
    throw BadInput("--camera", "auto", "places the camera itself, --eye and --target do it too: give one of the two");
  if (request.eye && *request.eye == *request.target) throw BadInput("--target", "", "is the same point as --eye");
}

void addLightOptions(CLI::App& command, LightRequest& request) {
  command
      .add_option("--light", request.texts,
                  "sun:X,Y,Z:DEGREES:LUX (where it travels, diameter of its disk), sphere:X,Y,Z:RADIUS:CANDELA, "
                  "rectangle:X,Y,Z:DX,DY,DZ:WIDTH,HEIGHT:CANDELA (centre, where it shines), or none; repeatable; "
                  "absent: the scene's own lights")
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("LIGHT");
  addPath(command, "--environment", "Equirectangular .hdr or .exr; absent: a sky", request.environment);
}

Lighting makeLighting(const Pose& pose, const LightRequest& request) {
  return makeLighting(pose, request.texts,
                      request.environment.empty() ? Environment{} : readEnvironment(request.environment));
}

void addBrdfOption(CLI::App& command, BrdfModel& model) {
  addValue(command, "--brdf",
           "What answers direct light: cook-torrance, as glTF defines it, the default; or blinn-phong of the same "
           "materials, to compare with what others publish",
           [&](auto& flag, auto& text) {
             if (text != brdfModelName(BrdfModel::CookTorrance) && text != brdfModelName(BrdfModel::BlinnPhong))
               throw BadInput(flag, fmt::format("\"{}\"", text), "is neither cook-torrance nor blinn-phong");
             model = text == brdfModelName(BrdfModel::BlinnPhong) ? BrdfModel::BlinnPhong : BrdfModel::CookTorrance;
           })
      ->type_name("MODEL");
}

void addExposureOption(CLI::App& command, float& exposureEv) {
  addValue(command, "--exposure", "Stops by which a .png is brightened, 0 by default", [&](auto& flag, auto& text) {
    exposureEv = static_cast<float>(parseNumber(flag, text, -64, 64));
  })->type_name("EV");
}

BakeSettings bakeSettingsOf(const Node& node, const SdfRequest& request, int threads) {
  BakeSettings settings;
  settings.resolution = request.resolution.value_or(node.sdf.resolution.value_or(settings.resolution));
  settings.bits = node.sdf.bits.value_or(settings.bits);
  settings.sign = node.sdf.sign.value_or(settings.sign);
  settings.thickness = node.sdf.thickness.value_or(settings.thickness);
  settings.attributes = !request.triplanarMetres && !node.sdf.triplanar;
  settings.threads = threads;
  settings.memoryBytes = request.memoryBytes.value_or(defaultMemoryBytes());
  return settings;
}

std::vector<float> triplanarNodes(const Scene& scene, const SdfRequest& request) {
  std::vector<float> metres;
  for (const Node& node : scene.nodes)
    metres.push_back(request.triplanarMetres.value_or(node.sdf.triplanar.value_or(0.0f)));
  return metres;
}

namespace {

/// A few names for a message about a pattern that matches none.
std::string someMeshNodes(const Scene& scene) {
  constexpr int kNamesShown = 6;
  std::string names;
  int count = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0 || node.name.empty()) continue;
    if (count++ < kNamesShown) names += (names.empty() ? "" : ", ") + node.name;
  }
  if (count == 0) return "none of them has a name";
  return fmt::format("there are: {}{}", names,
                     count > kNamesShown ? fmt::format(" and {} more", count - kNamesShown) : "");
}

std::vector<bool> matchedNodes(const Scene& scene, const std::string& pattern) {
  std::vector<bool> isMatched(scene.nodes.size(), false);
  bool isAny = false;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    isMatched[i] = node.mesh >= 0 && (pattern == "all" || ::fnmatch(pattern.c_str(), node.name.c_str(), 0) == 0);
    isAny = isAny || isMatched[i];
  }
  if (!isAny && pattern != "all")
    throw BadInput("--sdf", fmt::format("\"{}\"", pattern), "matches no node with a mesh; " + someMeshNodes(scene));
  return isMatched;
}

} // namespace

std::vector<std::optional<BakeSettings>> sdfNodes(const Scene& scene, const SdfRequest& request, int threads) {
  std::vector<bool> isSdf(scene.nodes.size(), false);
  if (request.patterns.empty())
    for (std::size_t i = 0; i < isSdf.size(); ++i) isSdf[i] = scene.nodes[i].sdf.sdf && scene.nodes[i].mesh >= 0;
  for (const std::string& pattern : request.patterns) {
    if ((pattern == "all" || pattern == "none") && request.patterns.size() > 1)
      throw BadInput("--sdf", pattern, "stands alone, not beside other patterns");
    if (pattern == "none") continue;
    if (pattern.empty()) throw BadInput("--sdf", "", "has an empty pattern");
    const std::vector<bool> isMatched = matchedNodes(scene, pattern);
    for (std::size_t i = 0; i < isSdf.size(); ++i) isSdf[i] = isSdf[i] || isMatched[i];
  }
  if (request.triplanarMetres && std::ranges::find(isSdf, true) == isSdf.end())
    throw BadInput("--triplanar", "", "is of SDF objects, and there are none; --sdf names them");
  std::vector<std::optional<BakeSettings>> settings(scene.nodes.size());
  for (std::size_t i = 0; i < isSdf.size(); ++i)
    if (isSdf[i]) settings[i] = bakeSettingsOf(scene.nodes[i], request, threads);
  return settings;
}

namespace {

/// Whatever way the two are written; a file that is not there yet counts as well.
bool isSameFile(const fs::path& a, const fs::path& b) {
  std::error_code ec;
  if (fs::equivalent(a, b, ec) && !ec) return true;
  const fs::path canonicalA = fs::weakly_canonical(fs::absolute(a, ec), ec);
  if (ec) return false;
  const fs::path canonicalB = fs::weakly_canonical(fs::absolute(b, ec), ec);
  return !ec && canonicalA == canonicalB;
}

} // namespace

void checkOutputs(const std::vector<OutputPath>& outputs, const std::vector<fs::path>& inputs) {
  for (const OutputPath& output : outputs) {
    if (output.path.empty()) continue;
    checkOutputPath(output.path, output.flag, output.extensions);
    for (const fs::path& input : inputs)
      if (!input.empty() && isSameFile(input, output.path))
        throw BadInput(output.path.string(), output.flag, "is a file that is read");
    for (const OutputPath& other : outputs) {
      if (&other == &output) break;
      if (!other.path.empty() && isSameFile(other.path, output.path) && !isWrittenInPlace(output.path))
        throw BadInput(output.path.string(), output.flag, fmt::format("is the file of {} too", other.flag));
    }
  }
}

void checkSceneFiles(const Scene& scene, const std::vector<OutputPath>& outputs) {
  for (const OutputPath& output : outputs)
    for (const fs::path& file : scene.files)
      if (!output.path.empty() && isSameFile(file, output.path))
        throw BadInput(output.path.string(), output.flag, fmt::format("is a file of {}", scene.name));
}

SignMethod parseSign(const std::string& flag, const std::string& text) {
  if (text == "auto") return SignMethod::Auto;
  if (text == "winding") return SignMethod::Winding;
  if (text == "parity") return SignMethod::Parity;
  if (text == "pseudonormal") return SignMethod::Pseudonormal;
  if (text == "two-sided") return SignMethod::TwoSided;
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of auto, winding, parity, pseudonormal, two-sided");
}

} // namespace brickfield
