// Names come first, numbers second: a node may be called "3".
#include "app/mesh_choice.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

std::vector<int> shownMeshNodes(const Pose& pose) {
  std::vector<int> nodes;
  for (const PosedInstance& instance : pose.instances)
    if (std::find(nodes.begin(), nodes.end(), instance.node) == nodes.end()) nodes.push_back(instance.node);
  return nodes;
}

std::string labelsOf(const Scene& scene, const std::vector<int>& nodes) {
  constexpr std::size_t kLabelsShown = 8;
  std::string labels;
  for (std::size_t i = 0; i < std::min(nodes.size(), kLabelsShown); ++i)
    labels += (i ? ", " : "") + nodeLabel(scene, nodes[i]);
  if (nodes.size() > kLabelsShown) labels += fmt::format(" and {} more", nodes.size() - kLabelsShown);
  return labels;
}

int nodeOf(const Scene& scene, const std::string& text) {
  std::vector<int> named;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].name == text) named.push_back(static_cast<int>(i));
  const std::string element = fmt::format("\"{}\"", text);
  if (named.size() > 1) throw BadInput("--node", element, "is the name of several: " + labelsOf(scene, named));
  if (named.size() == 1) return named.front();
  std::size_t number = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end || number >= scene.nodes.size())
    throw BadInput("--node", element, "is neither name nor number of a node");
  return static_cast<int>(number);
}

} // namespace

const PosedInstance& chooseMesh(const Scene& scene, const Pose& pose, const std::string& node) {
  const std::vector<int> shown = shownMeshNodes(pose);
  if (node.empty() && shown.empty()) throw BadInput(scene.name, "", "shows no mesh");
  if (node.empty() && shown.size() > 1)
    throw BadInput(scene.name, "", "has several meshes, choose one with --node: " + labelsOf(scene, shown));
  const int chosen = node.empty() ? shown.front() : nodeOf(scene, node);
  if (scene.nodes[static_cast<std::size_t>(chosen)].mesh < 0)
    throw BadInput("--node", nodeLabel(scene, chosen), "has no mesh; with one: " + labelsOf(scene, shown));
  const auto found = std::find_if(pose.instances.begin(), pose.instances.end(),
                                  [&](const PosedInstance& instance) { return instance.node == chosen; });
  if (found == pose.instances.end())
    throw BadInput("--node", nodeLabel(scene, chosen), "is not in the scene that is shown");
  return *found;
}

} // namespace brickfield
