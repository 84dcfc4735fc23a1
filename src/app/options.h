// Flags that several commands share, and what they become. Each add* puts a group of flags on a command; the values are
// complete and checked once the command line is parsed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bakers/bake.h"
#include "scene/brdf.h"
#include "scene/lighting.h"
#include "scene/view.h"

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace brickfield {

/// A flag with one value that `take` parses: (flag, text). Given twice is an error.
CLI::Option* addValue(CLI::App& command, const std::string& flag, const std::string& help,
                      std::function<void(const std::string& flag, const std::string& text)> take);

/// A flag whose value is a file or folder; an empty text is refused, and "-o=FILE", which would write "=FILE".
CLI::Option* addPath(CLI::App& command, const std::string& flag, const std::string& help, std::filesystem::path& path);

/// A flag whose value is a name; an empty text is refused.
CLI::Option* addName(CLI::App& command, const std::string& flag, const std::string& help, std::string& name);

/// Which nodes become SDF objects, and how they are baked.
struct SdfRequest {
  std::vector<std::string> patterns;      ///< "all", "none" or globs of node names; empty: what the scene's extras say
  std::optional<int> resolution;          ///< of every SDF node; wins over its extras
  std::optional<float> triplanarMetres{}; ///< of every SDF node; wins over its extras
  std::optional<std::uint64_t> memoryBytes{}; ///< that a bake may take; nothing: most of the machine's
};

/// --memory
void addMemoryOption(CLI::App& command, SdfRequest& request);

/// A scene at one moment.
struct SceneRequest {
  std::filesystem::path path;
  PoseRequest pose;
  SdfRequest sdf;
  std::optional<std::filesystem::path> cacheFolder; ///< of baked bricks; nothing: the user's own
  int threads = 0;                                  ///< 0: all
  std::uint64_t seed = 0;
};
/// SCENE --time --animation --sdf --resolution --triplanar --memory --cache --threads --seed
void addSceneOptions(CLI::App& command, SceneRequest& request);

/// --size --camera --eye --target --fov
void addCameraOptions(CLI::App& command, CameraRequest& request);
/// error BadInput: --eye without --target or the other way round, both the same point, or beside --camera auto
void checkCamera(const CameraRequest& request);

struct LightRequest {
  std::vector<std::string> texts;    ///< as makeLighting takes them
  std::filesystem::path environment; ///< empty: the sky
};
/// --light --environment
void addLightOptions(CLI::App& command, LightRequest& request);
/// The environment read, the texts turned into lights. error BadInput that names the flag or file
Lighting makeLighting(const Pose& pose, const LightRequest& request);

/// --brdf
void addBrdfOption(CLI::App& command, BrdfModel& model);

/// --exposure
void addExposureOption(CLI::App& command, float& exposureEv);

/// Bake settings of a node: its extras, and what is given here on top.
BakeSettings bakeSettingsOf(const Node& node, const SdfRequest& request, int threads);

/// How each node of the scene is baked; nothing where it is drawn as a mesh.
///
/// returns   as many entries as nodes; only nodes with a mesh have settings
/// error     BadInput that names --sdf and the pattern that matches no node with a mesh, or "all" or "none" beside
/// others proved by tests/unit/app/options_test.cpp
std::vector<std::optional<BakeSettings>> sdfNodes(const Scene& scene, const SdfRequest& request, int threads);

/// Metres of object space that a node's textures span where they are projected onto its SDF object; 0 where its field
/// has attributes of its own.
///
/// returns   as many as nodes
std::vector<float> triplanarNodes(const Scene& scene, const SdfRequest& request);

/// A file that a command will write.
struct OutputPath {
  std::string flag;
  std::filesystem::path path; ///< empty: not asked for
  std::vector<std::string> extensions;
};
/// Checks before the long work that each output that is asked for can be written, and that none is another one or one
/// of the files that are read (empty paths count as none), which would overwrite it. A device may be named twice.
/// error  BadInput that names file and flag
void checkOutputs(const std::vector<OutputPath>& outputs, const std::vector<std::filesystem::path>& inputs);
/// Checks that no output is a buffer or an image of the scene, read or not.
/// error  BadInput that names file, flag and scene
void checkSceneFiles(const Scene& scene, const std::vector<OutputPath>& outputs);

/// "auto", "winding", "parity", "pseudonormal", "two-sided". error BadInput that names the flag
SignMethod parseSign(const std::string& flag, const std::string& text);

} // namespace brickfield
