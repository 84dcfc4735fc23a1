// Times must be finite, not negative and strictly increasing; values as many as times, components and interpolation
// ask.
#include "scene/gltf_animation.h"

#include <set>
#include <utility>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_accessor.h"
#include "scene/gltf_schema.h"

namespace brickfield {

namespace {

constexpr const char* kFloatsOrNormalized = "f32 i8n u8n i16n u16n";

std::optional<AnimatedProperty> propertyOf(const std::string& path) {
  if (path == "translation") return AnimatedProperty::Translation;
  if (path == "rotation") return AnimatedProperty::Rotation;
  if (path == "scale") return AnimatedProperty::Scale;
  if (path == "weights") return AnimatedProperty::MorphWeights;
  return std::nullopt;
}

Interpolation interpolationOf(const std::string& name) {
  if (name == "STEP") return Interpolation::Step;
  return name == "CUBICSPLINE" ? Interpolation::CubicSpline : Interpolation::Linear;
}

class ChannelReader {
public:
  ChannelReader(GltfDocument& document, const Scene& scene, std::string element)
      : document_(document), scene_(scene), element_(std::move(element)) {}

  std::optional<AnimationChannel> read(const tinygltf::AnimationChannel& source,
                                       const tinygltf::AnimationSampler& sampler) {
    const std::optional<AnimatedProperty> property = propertyOf(source.target_path);
    if (!property) return leaveOut(fmt::format("path \"{}\" is not known", source.target_path));
    if (source.target_node < 0) return leaveOut("names no node");
    AnimationChannel channel;
    channel.node = source.target_node;
    channel.property = *property;
    channel.interpolation = interpolationOf(sampler.interpolation);
    channel.components = componentsOf(channel);
    const bool isWeights = channel.property == AnimatedProperty::MorphWeights;
    checkFormat(document_, sampler.input, {"SCALAR", "f32", false}, element_ + ": times");
    const bool isVector =
        channel.property == AnimatedProperty::Translation || channel.property == AnimatedProperty::Scale;
    checkFormat(document_, sampler.output,
                {isWeights  ? "SCALAR"
                 : isVector ? "VEC3"
                            : "VEC4",
                 isVector ? "f32" : kFloatsOrNormalized, false},
                element_ + ": values");
    const std::uint64_t keys = accessorCount(document_, sampler.input);
    const bool isCubic = channel.interpolation == Interpolation::CubicSpline;
    if (isCubic && keys < 2) document_.refuse(element_, "has one key, CUBICSPLINE needs two");
    const std::uint64_t elements =
        keys * (isCubic ? 3 : 1) * (isWeights ? static_cast<std::uint64_t>(channel.components) : 1);
    if (const std::uint64_t count = accessorCount(document_, sampler.output); count != elements)
      document_.refuse(element_, fmt::format("has {} values for {} keys, not {}", count, keys, elements));
    if (accessorIsEmpty(document_, sampler.input)) return leaveOut("its times have no data");
    document_.spendVertices(keys + elements, element_);
    channel.seconds = readFloats(document_, sampler.input);
    channel.values = readFloats(document_, sampler.output);
    checkTimes(channel.seconds);
    if (channel.property == AnimatedProperty::Rotation) normalizeRotations(channel);
    return channel;
  }

private:
  std::optional<AnimationChannel> leaveOut(std::string_view reason) {
    document_.warnings.push_back(fmt::format("{}: {}; it is left out", element_, reason));
    return std::nullopt;
  }

  int componentsOf(const AnimationChannel& channel) const {
    const Node& node = scene_.nodes[static_cast<std::size_t>(channel.node)];
    if (channel.property == AnimatedProperty::Rotation) return 4;
    if (channel.property != AnimatedProperty::MorphWeights) return 3;
    const std::size_t targets =
        node.mesh < 0 ? 0 : scene_.meshes[static_cast<std::size_t>(node.mesh)].morphWeights.size();
    if (targets == 0)
      document_.refuse(element_,
                       fmt::format("moves weights of {}, which has no morph targets", nodeLabel(scene_, channel.node)));
    return static_cast<int>(targets);
  }

  void checkTimes(const std::vector<float>& seconds) const {
    if (seconds[0] < 0.0f) document_.refuse(element_, fmt::format("key 0 is at {} s, before 0", seconds[0]));
    for (std::size_t i = 1; i < seconds.size(); ++i)
      if (!(seconds[i] > seconds[i - 1]))
        document_.refuse(
            element_, fmt::format("key {} at {} s is not after key {} at {} s", i, seconds[i], i - 1, seconds[i - 1]));
  }

  // Quaternions of keys are made unit; tangents of splines are differences and stay.
  void normalizeRotations(AnimationChannel& channel) {
    const bool isCubic = channel.interpolation == Interpolation::CubicSpline;
    constexpr float kTolerance = 0.02f; // eight normalized bits err by 0.8 % in four components
    std::size_t rescaled = 0;
    for (std::size_t key = 0; key < channel.seconds.size(); ++key) {
      float* const xyzw = channel.values.data() + (isCubic ? 12 * key + 4 : 4 * key);
      const glm::vec4 value(xyzw[0], xyzw[1], xyzw[2], xyzw[3]);
      const float length = glm::length(value);
      if (!(length > 0.0f) || !std::isfinite(length))
        document_.refuse(element_, fmt::format("key {} is no quaternion: its length is {}", key, length));
      if (std::abs(length - 1.0f) > kTolerance) ++rescaled;
      if (isCubic) continue;
      for (int i = 0; i < 4; ++i) xyzw[i] = value[i] / length;
    }
    if (rescaled > 0) document_.warnings.push_back(fmt::format("{}: {} rotations are not unit", element_, rescaled));
  }

  GltfDocument& document_;
  const Scene& scene_;
  std::string element_;
};

} // namespace

void importAnimations(GltfDocument& document, Scene& scene) {
  for (std::size_t a = 0; a < document.model->animations.size(); ++a) {
    const tinygltf::Animation& source = document.model->animations[a];
    const std::string element = elementLabel("animation", a, source.name);
    Animation& animation = scene.animations.emplace_back();
    animation.name = source.name;
    std::set<std::pair<int, std::string>> targets;
    for (std::size_t c = 0; c < source.channels.size(); ++c) {
      const tinygltf::AnimationChannel& channel = source.channels[c];
      const std::string channelElement = fmt::format("{} channel {}", element, c);
      if (static_cast<std::size_t>(channel.sampler) >= source.samplers.size())
        document.refuse(channelElement, fmt::format("sampler {} does not exist, the animation has {}", channel.sampler,
                                                    source.samplers.size()));
      if (channel.target_node >= 0) {
        if (!targets.emplace(channel.target_node, channel.target_path).second)
          document.refuse(channelElement, fmt::format("moves the {} of {}, as another channel does",
                                                      channel.target_path, nodeLabel(scene, channel.target_node)));
        const Node& node = scene.nodes[static_cast<std::size_t>(channel.target_node)];
        if (node.matrix && channel.target_path != "weights")
          document.refuse(channelElement,
                          fmt::format("moves {}, which has a matrix", nodeLabel(scene, channel.target_node)));
      }
      const tinygltf::AnimationSampler& sampler = source.samplers[static_cast<std::size_t>(channel.sampler)];
      if (std::optional<AnimationChannel> read = ChannelReader(document, scene, channelElement).read(channel, sampler))
        animation.channels.push_back(std::move(*read));
    }
  }
}

} // namespace brickfield
