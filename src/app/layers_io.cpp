// One table says which layer is which part with which channels; writing and reading both walk it.
#include "app/layers_io.h"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>

#include "app/exr.h"
#include "core/error.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

using Floats = std::vector<float>;

Floats floatsOf(const std::vector<glm::vec3>& values) {
  Floats floats;
  floats.reserve(values.size() * 3);
  for (const glm::vec3& value : values) floats.insert(floats.end(), {value.x, value.y, value.z});
  return floats;
}

std::vector<glm::vec3> vectorsOf(const Floats& floats) {
  std::vector<glm::vec3> values(floats.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = {floats[3 * i], floats[3 * i + 1], floats[3 * i + 2]};
  return values;
}

template <typename Whole>
Floats floatsOfWhole(const std::vector<Whole>& values) {
  Floats floats;
  floats.reserve(values.size());
  for (const Whole value : values) floats.push_back(static_cast<float>(value));
  return floats;
}

/// Refuses what the cast could not hold; `part` begins the message.
template <typename Whole>
std::vector<Whole> wholeOf(const Floats& floats, float least, float most) {
  std::vector<Whole> values;
  values.reserve(floats.size());
  for (const float value : floats) {
    if (!(value >= least && value <= most) || value != std::floor(value))
      throw BadInput(fmt::format("{} is no whole number from {} to {}", value, least, most));
    values.push_back(static_cast<Whole>(value));
  }
  return values;
}

struct LayerFormat {
  const char* name;
  std::vector<std::string> channels;
  std::function<Floats(const FrameLayers&)> get;
  std::function<void(FrameLayers&, const Floats&)> set;
};

constexpr float kMostWholeFloat = 16777216.0f; // 2^24: beyond it floats skip whole numbers

const std::array<LayerFormat, 10>& layerFormats() {
  static const std::vector<std::string> rgb{"R", "G", "B"}, xyz{"X", "Y", "Z"};
  static const std::array<LayerFormat, 10> formats{{
      {"color", rgb, [](const FrameLayers& l) { return floatsOf(l.color); },
       [](FrameLayers& l, const Floats& f) { l.color = vectorsOf(f); }},
      {"depth",
       {"Z"},
       [](const FrameLayers& l) { return l.depth; },
       [](FrameLayers& l, const Floats& f) { l.depth = f; }},
      {"normal", xyz, [](const FrameLayers& l) { return floatsOf(l.normal); },
       [](FrameLayers& l, const Floats& f) { l.normal = vectorsOf(f); }},
      {"normal_surface", xyz, [](const FrameLayers& l) { return floatsOf(l.normalSurface); },
       [](FrameLayers& l, const Floats& f) { l.normalSurface = vectorsOf(f); }},
      {"albedo", rgb, [](const FrameLayers& l) { return floatsOf(l.albedo); },
       [](FrameLayers& l, const Floats& f) { l.albedo = vectorsOf(f); }},
      {"id",
       {"ID"},
       [](const FrameLayers& l) { return floatsOfWhole(l.id); },
       [](FrameLayers& l, const Floats& f) { l.id = wholeOf<std::int32_t>(f, -1.0f, kMostWholeFloat); }},
      {"kind",
       {"KIND"},
       [](const FrameLayers& l) { return floatsOfWhole(l.kind); },
       [](FrameLayers& l, const Floats& f) { l.kind = wholeOf<SurfaceKind>(f, 0.0f, 2.0f); }},
      {"ao",
       {"AO"},
       [](const FrameLayers& l) { return l.ambientOcclusion; },
       [](FrameLayers& l, const Floats& f) { l.ambientOcclusion = f; }},
      {"thickness",
       {"METRES"},
       [](const FrameLayers& l) { return l.thickness; },
       [](FrameLayers& l, const Floats& f) { l.thickness = f; }},
      {"steps",
       {"STEPS"},
       [](const FrameLayers& l) { return l.steps; },
       [](FrameLayers& l, const Floats& f) { l.steps = f; }},
  }};
  return formats;
}

/// "shadow", "shadow_1", "shadow_2", ...: by the number of the light.
std::string shadowPartName(std::size_t light) { return light == 0 ? "shadow" : fmt::format("shadow_{}", light); }
const std::vector<std::string> kShadowChannels{"V"};

/// The part's values with exactly these channels in this order.
Floats channelsOf(const ImagePart& part, const std::vector<std::string>& wanted) {
  std::vector<std::size_t> columns;
  for (const std::string& channel : wanted) {
    const auto found = std::find(part.channels.begin(), part.channels.end(), channel);
    if (found == part.channels.end()) throw BadInput(fmt::format("has no channel {}", channel));
    columns.push_back(static_cast<std::size_t>(found - part.channels.begin()));
  }
  const std::size_t pixels = std::size_t{part.size.x} * part.size.y;
  Floats floats;
  floats.reserve(pixels * columns.size());
  for (std::size_t i = 0; i < pixels; ++i)
    for (const std::size_t column : columns) floats.push_back(part.values[i * part.channels.size() + column]);
  return floats;
}

} // namespace

void writeLayers(const fs::path& path, const FrameLayers& layers) {
  const std::size_t pixels = std::size_t{layers.size.x} * layers.size.y;
  std::vector<ImagePart> parts;
  const auto add = [&](const std::string& name, const std::vector<std::string>& channels, Floats values) {
    if (values.empty()) return;
    if (values.size() != pixels * channels.size())
      throw Failure(
          fmt::format("layer {} has {} values for {} x {} pixels", name, values.size(), layers.size.x, layers.size.y));
    parts.push_back({name, layers.size, channels, std::move(values)});
  };
  for (const LayerFormat& format : layerFormats()) add(format.name, format.channels, format.get(layers));
  for (std::size_t light = 0; light < layers.shadow.size(); ++light)
    add(shadowPartName(light), kShadowChannels, layers.shadow[light]);
  if (parts.empty()) throw Failure("no layer to write");
  writeExrParts(path, parts);
}

FrameLayers readLayers(const fs::path& path) {
  std::vector<ImagePart> parts = readExrParts(path);
  if (parts.size() == 1 && parts[0].name.empty()) parts[0].name = "color";
  FrameLayers layers;
  const auto read = [&](const std::string& name, const std::vector<std::string>& channels, const auto& take) {
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const ImagePart& p) { return p.name == name; });
    if (part == parts.end()) return false;
    const std::string element = fmt::format("part {}", name);
    if (layers.size != glm::uvec2(0) && layers.size != part->size)
      throw BadInput(path.string(), element, "its size differs from the parts before");
    layers.size = part->size;
    try {
      take(channelsOf(*part, channels));
    } catch (const BadInput& error) {
      throw BadInput(path.string(), element, error.what());
    }
    return true;
  };
  for (const LayerFormat& format : layerFormats())
    read(format.name, format.channels, [&](const Floats& values) { format.set(layers, values); });
  while (read(shadowPartName(layers.shadow.size()), kShadowChannels,
              [&](const Floats& values) { layers.shadow.push_back(values); })) {
  }
  if (layers.size == glm::uvec2(0)) throw BadInput(path.string(), "", "has no layer that is known here");
  return layers;
}

} // namespace brickfield
