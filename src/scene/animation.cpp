// Key frame interpolation after glTF 2.0, 3.11 and appendix C: steps, lines (slerp for rotations), Hermite splines.
#include "scene/animation.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "core/error.h"

namespace brickfield {

namespace {

glm::quat quaternionFrom(std::span<const float> xyzw) {
  glm::quat q(1.0f, 0.0f, 0.0f, 0.0f);
  q.x = xyzw[0], q.y = xyzw[1], q.z = xyzw[2], q.w = xyzw[3];
  return q;
}

void storeQuaternion(glm::quat q, std::span<float> xyzw) { xyzw[0] = q.x, xyzw[1] = q.y, xyzw[2] = q.z, xyzw[3] = q.w; }

glm::quat normalizedOrIdentity(glm::quat q) {
  const float length = glm::length(q);
  return length > 0.0f ? q / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
}

/// The shorter of both arcs between unit quaternions (Shoemake 1985).
glm::quat slerp(glm::quat a, glm::quat b, float weight) {
  float cosine = glm::dot(a, b);
  if (cosine < 0.0f) b = -b, cosine = -cosine;
  // Nearly the same rotation: sin(angle) loses its digits, and the chord differs from the arc by less than a rounding.
  constexpr float kNearlyOne = 0.99999f;
  if (cosine > kNearlyOne) return normalizedOrIdentity(a * (1.0f - weight) + b * weight);
  const float angle = std::acos(cosine);
  return normalizedOrIdentity((a * std::sin((1.0f - weight) * angle) + b * std::sin(weight * angle)) / std::sin(angle));
}

/// One value of a key. Splines store three a key: in-tangent, value, out-tangent.
std::span<const float> keyValue(const AnimationChannel& channel, std::size_t key, std::size_t part) {
  const auto components = static_cast<std::size_t>(channel.components);
  const std::size_t parts = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
  return std::span(channel.values).subspan((key * parts + (parts == 3 ? part : 0)) * components, components);
}

constexpr std::size_t kInTangent = 0, kValue = 1, kOutTangent = 2;

void interpolateKeys(const AnimationChannel& channel, std::size_t key, double seconds, std::span<float> value) {
  const std::span<const float> from = keyValue(channel, key, kValue), to = keyValue(channel, key + 1, kValue);
  const double keyDelta = double{channel.seconds[key + 1]} - channel.seconds[key];
  const double t = (seconds - channel.seconds[key]) / keyDelta;
  if (channel.interpolation == Interpolation::Linear) {
    if (channel.property == AnimatedProperty::Rotation) {
      storeQuaternion(slerp(normalizedOrIdentity(quaternionFrom(from)), normalizedOrIdentity(quaternionFrom(to)),
                            static_cast<float>(t)),
                      value);
      return;
    }
    for (std::size_t i = 0; i < value.size(); ++i) value[i] = static_cast<float>((1.0 - t) * from[i] + t * to[i]);
    return;
  }
  const std::span<const float> outTangent = keyValue(channel, key, kOutTangent);
  const std::span<const float> inTangent = keyValue(channel, key + 1, kInTangent);
  const double t2 = t * t, t3 = t2 * t;
  for (std::size_t i = 0; i < value.size(); ++i)
    value[i] = static_cast<float>((2 * t3 - 3 * t2 + 1) * from[i] + keyDelta * (t3 - 2 * t2 + t) * outTangent[i] +
                                  (-2 * t3 + 3 * t2) * to[i] + keyDelta * (t3 - t2) * inTangent[i]);
}

void store(const AnimationChannel& channel, std::span<const float> value, LocalPose& pose) {
  const auto node = static_cast<std::size_t>(channel.node);
  LocalTransform& local = pose.transforms[node];
  if (channel.property == AnimatedProperty::MorphWeights) {
    pose.morphWeights[node].assign(value.begin(), value.end());
    return;
  }
  local.matrix.reset(); // the format forbids both; the animation's word counts
  if (channel.property == AnimatedProperty::Translation) local.translation = {value[0], value[1], value[2]};
  if (channel.property == AnimatedProperty::Scale) local.scale = {value[0], value[1], value[2]};
  if (channel.property == AnimatedProperty::Rotation) local.rotation = quaternionFrom(value);
}

} // namespace

glm::mat4 LocalTransform::parentFromNode() const {
  if (matrix) return *matrix;
  const glm::mat3 turned = glm::mat3_cast(rotation);
  return {glm::vec4(turned[0] * scale.x, 0.0f), glm::vec4(turned[1] * scale.y, 0.0f),
          glm::vec4(turned[2] * scale.z, 0.0f), glm::vec4(translation, 1.0f)};
}

LocalPose restPose(const Scene& scene) {
  LocalPose pose;
  pose.transforms.reserve(scene.nodes.size());
  pose.morphWeights.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) {
    pose.transforms.push_back({node.matrix, node.translation, node.rotation, node.scale});
    pose.morphWeights.push_back(node.morphWeights);
  }
  return pose;
}

std::vector<std::size_t> chooseAnimations(const Scene& scene, const std::string& text) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < scene.animations.size(); ++i) {
    if (text == "all")
      chosen.push_back(i);
    else if (text == scene.animations[i].name)
      return {i};
  }
  if (text == "all") return chosen;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number < scene.animations.size()) return {number};
  throw BadInput(scene.name, "animation \"" + text + "\"",
                 scene.animations.empty() ? "the scene has no animations"
                                          : "no such name or number; the scene has " +
                                                std::to_string(scene.animations.size()) + ", counted from 0");
}

void sampleChannel(const AnimationChannel& channel, double seconds, std::span<float> value) {
  const std::vector<float>& keys = channel.seconds;
  // The last key at or before the time; clamped to the keys.
  const auto after = std::upper_bound(keys.begin(), keys.end(), seconds,
                                      [](double wanted, float key) { return wanted < double{key}; });
  const std::size_t key = after == keys.begin() ? 0 : static_cast<std::size_t>(after - keys.begin()) - 1;
  const bool onKey = key + 1 >= keys.size() || seconds <= keys[key] || channel.interpolation == Interpolation::Step;
  if (onKey)
    std::ranges::copy(keyValue(channel, key, kValue), value.begin());
  else
    interpolateKeys(channel, key, seconds, value);
  if (channel.property == AnimatedProperty::Rotation)
    storeQuaternion(normalizedOrIdentity(quaternionFrom(value)), value);
}

void animate(const Scene& scene, std::span<const std::size_t> animations, double seconds, LocalPose& pose) {
  std::set<std::pair<int, AnimatedProperty>> moved;
  std::vector<float> value;
  for (const std::size_t animation : animations)
    for (const AnimationChannel& channel : scene.animations[animation].channels) {
      if (channel.node < 0 || channel.seconds.empty()) continue;
      if (!moved.emplace(channel.node, channel.property).second) continue;
      value.assign(static_cast<std::size_t>(channel.components), 0.0f);
      sampleChannel(channel, seconds, value);
      store(channel, value, pose);
    }
}

} // namespace brickfield
