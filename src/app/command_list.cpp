// One line an entry on stdout: the name, then what it means.
#include "app/command_list.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/field_error_view.h"
#include "app/image_io.h"
#include "app/options.h"
#include "app/session.h"
#include "core/error.h"
#include "gpu/context.h"
#include "renderer/renderer.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

int printViews() {
  const auto print = [](const DebugView& view) { fmt::print("{:<24} {}\n", view.name, view.meaning); };
  for (const DebugView& view : debugViews()) print(view);
  if (const DebugView* error = fieldErrorView()) print(*error);
  return 0;
}

int printPasses() {
  for (const std::string& name : framePassNames()) fmt::print("{}\n", name);
  return 0;
}

int printCameras(const std::filesystem::path& path) {
  checkInputPath(path, {".gltf", ".glb"});
  const Scene scene = importGltf(path);
  const Pose pose = poseScene(scene, {});
  // No warnings: the importer's are on what is drawn; a wrong camera is an error.
  for (std::size_t i = 0; i < pose.cameraNodes.size(); ++i) {
    const int node = pose.cameraNodes[i];
    const Camera& camera = scene.cameras[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].camera)];
    const std::string optics =
        camera.orthographic ? fmt::format("orthographic, {:g} m high", 2.0f * camera.halfExtent.y)
                            : fmt::format("perspective, {:.1f} degrees", glm::degrees(camera.verticalFovRadians));
    fmt::print("{:<4} {} {}, {}\n", i, camera.name.empty() ? "-" : camera.name, nodeLabel(scene, node), optics);
  }
  if (pose.cameraNodes.empty()) fmt::print("none; --camera auto frames the scene\n");
  return 0;
}

int printDevices() {
  for (const DeviceInfo& device : listDevices())
    fmt::print("{:<4} {}\n", device.index,
               device.error.empty() ? fmt::format("{}, OpenGL {}{}", device.context.renderer, device.context.version,
                                                  device.context.isSoftware ? ", software" : "")
                                    : "unusable: " + device.error);
  return 0;
}

} // namespace

void addListCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("list", "List what other commands take by name");
  command.require_subcommand(0, 1);
  command.callback([&command] {
    if (command.get_subcommands().empty()) throw BadInput("list", "", "needs one of views, passes, cameras, devices");
  });
  const auto add = [&](const char* name, const char* description, CommandAction action) {
    command.add_subcommand(name, description)->callback([action, &chosen] { chosen = action; });
  };
  add("views", "What --view takes", [] { return printViews(); });
  add("passes", "The passes of a frame, in order", [] { return printPasses(); });
  add("devices", "What --device takes", [] { return printDevices(); });
  CLI::App& cameras = *command.add_subcommand("cameras", "What --camera takes for a scene");
  const auto scene = std::make_shared<std::filesystem::path>();
  addPath(cameras, "SCENE", "glTF 2.0 file (.gltf or .glb)", *scene)->required();
  cameras.callback([scene, &chosen] { chosen = [scene] { return printCameras(*scene); }; });
}

} // namespace brickfield
