// A table of members and one walker over it, after the JSON schemas of glTF 2.0 and of the extensions that we read.
// tinygltf takes defaults where a type is wrong and casts 64-bit numbers to int: behind this check it cannot.
#include "scene/gltf_schema.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

using nlohmann::json;

enum class Form {
  Index,     // into the root array `detail`
  Indices,   // array of them, each at most once
  IndexMap,  // object whose members are indices
  IndexMaps, // array of those
  Integer,   // of [least, most]
  Number,    // finite, of [least, most]
  Numbers,   // array of `length` (0: any) finite numbers, each of [least, most]
  Flag,
  Text, // any string, or one of `detail` ("A|B")
  Texts,
  Code,    // integer, one of `detail` ("5120|5121")
  Object,  // of owner `detail`
  Objects, // array of those
};

struct Member {
  std::string_view owner;
  std::string_view name;
  Form form;
  std::string_view detail = {};
  bool required = false;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::size_t length = 0;
};

constexpr bool kRequired = true;
constexpr bool kOptional = false;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostBytes = 9007199254740992.0; // 2^53: every integer up to here is a double
constexpr double kMostInt = 2147483647.0;         // what tinygltf keeps in an int
constexpr double kMostCount = 4294967295.0;
// Factors that an exporter rounded may lie this far outside of [0,1]; they are clamped where they are read.
constexpr double kRounding = 1e-5;
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

constexpr Member kMembers[] = {
    {"glTF", "asset", Form::Object, "asset", kRequired},
    {"glTF", "extensionsUsed", Form::Texts},
    {"glTF", "extensionsRequired", Form::Texts},
    {"glTF", "scene", Form::Index, "scenes"},
    {"glTF", "accessors", Form::Objects, "accessor"},
    {"glTF", "animations", Form::Objects, "animation"},
    {"glTF", "buffers", Form::Objects, "buffer"},
    {"glTF", "bufferViews", Form::Objects, "bufferView"},
    {"glTF", "cameras", Form::Objects, "camera"},
    {"glTF", "images", Form::Objects, "image"},
    {"glTF", "materials", Form::Objects, "material"},
    {"glTF", "meshes", Form::Objects, "mesh"},
    {"glTF", "nodes", Form::Objects, "node"},
    {"glTF", "samplers", Form::Objects, "sampler"},
    {"glTF", "scenes", Form::Objects, "scene"},
    {"glTF", "skins", Form::Objects, "skin"},
    {"glTF", "textures", Form::Objects, "texture"},
    {"asset", "version", Form::Text, "", kRequired},
    {"asset", "minVersion", Form::Text},
    {"accessor", "bufferView", Form::Index, "bufferViews"},
    {"accessor", "byteOffset", Form::Integer, "", kOptional, 0, kMostBytes},
    {"accessor", "componentType", Form::Code, "5120|5121|5122|5123|5125|5126", kRequired},
    {"accessor", "normalized", Form::Flag},
    {"accessor", "count", Form::Integer, "", kRequired, 1, kMostCount},
    {"accessor", "type", Form::Text, "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4", kRequired},
    {"accessor", "min", Form::Numbers},
    {"accessor", "max", Form::Numbers},
    {"accessor", "sparse", Form::Object, "sparse"},
    {"sparse", "count", Form::Integer, "", kRequired, 1, kMostInt},
    {"sparse", "indices", Form::Object, "sparseIndices", kRequired},
    {"sparse", "values", Form::Object, "sparseValues", kRequired},
    {"sparseIndices", "bufferView", Form::Index, "bufferViews", kRequired},
    {"sparseIndices", "byteOffset", Form::Integer, "", kOptional, 0, kMostInt},
    {"sparseIndices", "componentType", Form::Code, "5121|5123|5125", kRequired},
    {"sparseValues", "bufferView", Form::Index, "bufferViews", kRequired},
    {"sparseValues", "byteOffset", Form::Integer, "", kOptional, 0, kMostInt},
    {"animation", "channels", Form::Objects, "channel", kRequired},
    {"animation", "samplers", Form::Objects, "animationSampler", kRequired},
    {"channel", "sampler", Form::Integer, "", kRequired, 0, kMostInt},
    {"channel", "target", Form::Object, "channelTarget", kRequired},
    {"channelTarget", "node", Form::Index, "nodes"},
    {"channelTarget", "path", Form::Text, "", kRequired},
    {"animationSampler", "input", Form::Index, "accessors", kRequired},
    {"animationSampler", "output", Form::Index, "accessors", kRequired},
    {"animationSampler", "interpolation", Form::Text, "LINEAR|STEP|CUBICSPLINE"},
    {"buffer", "uri", Form::Text},
    {"buffer", "byteLength", Form::Integer, "", kRequired, 1, kMostBytes},
    {"bufferView", "buffer", Form::Index, "buffers", kRequired},
    {"bufferView", "byteOffset", Form::Integer, "", kOptional, 0, kMostBytes},
    {"bufferView", "byteLength", Form::Integer, "", kRequired, 1, kMostBytes},
    {"bufferView", "byteStride", Form::Integer, "", kOptional, 4, 252},
    {"camera", "type", Form::Text, "perspective|orthographic", kRequired},
    {"camera", "perspective", Form::Object, "perspective"},
    {"camera", "orthographic", Form::Object, "orthographic"},
    {"perspective", "aspectRatio", Form::Number, "", kOptional, kTiny},
    {"perspective", "yfov", Form::Number, "", kRequired, kTiny},
    {"perspective", "zfar", Form::Number, "", kOptional, kTiny},
    {"perspective", "znear", Form::Number, "", kRequired, kTiny},
    {"orthographic", "xmag", Form::Number, "", kRequired},
    {"orthographic", "ymag", Form::Number, "", kRequired},
    {"orthographic", "zfar", Form::Number, "", kRequired, kTiny},
    {"orthographic", "znear", Form::Number, "", kRequired, 0},
    {"image", "uri", Form::Text},
    {"image", "mimeType", Form::Text},
    {"image", "bufferView", Form::Index, "bufferViews"},
    {"material", "pbrMetallicRoughness", Form::Object, "pbrMetallicRoughness"},
    {"material", "normalTexture", Form::Object, "textureInfo"},
    {"material", "occlusionTexture", Form::Object, "textureInfo"},
    {"material", "emissiveTexture", Form::Object, "textureInfo"},
    {"material", "emissiveFactor", Form::Numbers, "", kOptional, -kRounding, 1 + kRounding, 3},
    {"material", "alphaMode", Form::Text, "OPAQUE|MASK|BLEND"},
    {"material", "alphaCutoff", Form::Number, "", kOptional, 0},
    {"material", "doubleSided", Form::Flag},
    {"pbrMetallicRoughness", "baseColorFactor", Form::Numbers, "", kOptional, -kRounding, 1 + kRounding, 4},
    {"pbrMetallicRoughness", "baseColorTexture", Form::Object, "textureInfo"},
    {"pbrMetallicRoughness", "metallicFactor", Form::Number, "", kOptional, -kRounding, 1 + kRounding},
    {"pbrMetallicRoughness", "roughnessFactor", Form::Number, "", kOptional, -kRounding, 1 + kRounding},
    {"pbrMetallicRoughness", "metallicRoughnessTexture", Form::Object, "textureInfo"},
    {"textureInfo", "index", Form::Index, "textures", kRequired},
    {"textureInfo", "texCoord", Form::Integer, "", kOptional, 0, kMostInt},
    {"textureInfo", "scale", Form::Number},
    {"textureInfo", "strength", Form::Number, "", kOptional, -kRounding, 1 + kRounding},
    {"mesh", "primitives", Form::Objects, "primitive", kRequired},
    {"mesh", "weights", Form::Numbers},
    {"primitive", "attributes", Form::IndexMap, "accessors", kRequired},
    {"primitive", "indices", Form::Index, "accessors"},
    {"primitive", "material", Form::Index, "materials"},
    {"primitive", "mode", Form::Integer, "", kOptional, 0, 6},
    {"primitive", "targets", Form::IndexMaps, "accessors"},
    {"node", "camera", Form::Index, "cameras"},
    {"node", "children", Form::Indices, "nodes"},
    {"node", "skin", Form::Index, "skins"},
    {"node", "matrix", Form::Numbers, "", kOptional, -kInfinity, kInfinity, 16},
    {"node", "mesh", Form::Index, "meshes"},
    {"node", "rotation", Form::Numbers, "", kOptional, -kInfinity, kInfinity, 4},
    {"node", "scale", Form::Numbers, "", kOptional, -kInfinity, kInfinity, 3},
    {"node", "translation", Form::Numbers, "", kOptional, -kInfinity, kInfinity, 3},
    {"node", "weights", Form::Numbers},
    {"sampler", "magFilter", Form::Code, "9728|9729"},
    {"sampler", "minFilter", Form::Code, "9728|9729|9984|9985|9986|9987"},
    {"sampler", "wrapS", Form::Code, "33071|33648|10497"},
    {"sampler", "wrapT", Form::Code, "33071|33648|10497"},
    {"scene", "nodes", Form::Indices, "nodes"},
    {"skin", "inverseBindMatrices", Form::Index, "accessors"},
    {"skin", "skeleton", Form::Index, "nodes"},
    {"skin", "joints", Form::Indices, "nodes", kRequired},
    {"texture", "sampler", Form::Index, "samplers"},
    {"texture", "source", Form::Index, "images"},
    {"textureInfo:KHR_texture_transform", "offset", Form::Numbers, "", kOptional, -kInfinity, kInfinity, 2},
    {"textureInfo:KHR_texture_transform", "rotation", Form::Number},
    {"textureInfo:KHR_texture_transform", "scale", Form::Numbers, "", kOptional, -kInfinity, kInfinity, 2},
    {"textureInfo:KHR_texture_transform", "texCoord", Form::Integer, "", kOptional, 0, kMostInt},
    {"material:KHR_materials_emissive_strength", "emissiveStrength", Form::Number, "", kOptional, 0},
    {"material:KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", Form::Number, "", kOptional,
     -kRounding, 1 + kRounding},
    {"material:KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor", Form::Numbers, "", kOptional, 0,
     kInfinity, 3},
    {"material:KHR_materials_volume", "attenuationDistance", Form::Number, "", kOptional, kTiny},
    {"material:KHR_materials_volume", "attenuationColor", Form::Numbers, "", kOptional, 0, 1 + kRounding, 3},
    {"glTF:KHR_lights_punctual", "lights", Form::Objects, "light", kRequired},
    {"light", "type", Form::Text, "directional|point|spot", kRequired},
    {"light", "color", Form::Numbers, "", kOptional, 0, kInfinity, 3},
    {"light", "intensity", Form::Number, "", kOptional, 0},
    {"light", "range", Form::Number, "", kOptional, kTiny},
    {"light", "spot", Form::Object, "spot"},
    {"spot", "innerConeAngle", Form::Number, "", kOptional, 0},
    {"spot", "outerConeAngle", Form::Number, "", kOptional, kTiny, 1.5707963267948966 + kRounding},
    {"node:KHR_lights_punctual", "light", Form::Index, "lights", kRequired},
    {"node:EXT_mesh_gpu_instancing", "attributes", Form::IndexMap, "accessors", kRequired},
};

class Walker {
public:
  Walker(json& document, std::string_view file) : document_(document), file_(file) {
    for (const Member& member : kMembers) members_[std::string(member.owner)].push_back(&member);
  }

  void walk() { checkObject(document_, "glTF", "", ""); }

private:
  [[noreturn]] void refuse(const std::string& element, const std::string& where, std::string_view reason) const {
    throw BadInput(file_, element.empty() ? "glTF" : element,
                   where.empty() ? std::string(reason) : fmt::format("{}: {}", where, reason));
  }

  // The number of elements that an index may point at.
  std::size_t targetCount(std::string_view array) const {
    const json* object = &document_;
    if (array == "lights") {
      if (!object->contains("extensions") || !(*object)["extensions"].is_object()) return 0;
      object = &(*object)["extensions"];
      if (!object->contains("KHR_lights_punctual") || !(*object)["KHR_lights_punctual"].is_object()) return 0;
      object = &(*object)["KHR_lights_punctual"];
    }
    const auto it = object->find(std::string(array));
    return it != object->end() && it->is_array() ? it->size() : 0;
  }

  // element names the root element ("node 3"), where the path below it.
  void checkObject(json& object, const std::string& owner, const std::string& element, const std::string& where) {
    if (!object.is_object()) refuse(element, where, fmt::format("is a JSON {}, not an object", object.type_name()));
    if (const auto rules = members_.find(owner); rules != members_.end()) {
      for (const Member* member : rules->second) {
        const auto it = object.find(std::string(member->name));
        const std::string path = where.empty() ? std::string(member->name) : fmt::format("{}.{}", where, member->name);
        if (it != object.end())
          checkMember(*member, *it, element, path);
        else if (member->required)
          refuse(element, path, "is missing");
      }
    }
    if (const auto it = object.find("name"); it != object.end() && owner != "glTF" && !it->is_string())
      refuse(element, where.empty() ? "name" : where + ".name", "is not a string");
    const auto extensions = object.find("extensions");
    if (extensions == object.end()) return;
    const std::string base = where.empty() ? "extensions" : where + ".extensions";
    if (!extensions->is_object()) refuse(element, base, "is not an object");
    for (auto& [name, extension] : extensions->items())
      checkObject(extension, fmt::format("{}:{}", owner, name), element, fmt::format("{}.{}", base, name));
  }

  void checkMember(const Member& member, json& value, const std::string& element, const std::string& path) {
    switch (member.form) {
    case Form::Index:
      return checkIndex(member, value, element, path);
    case Form::Indices:
      return checkIndices(member, value, element, path);
    case Form::IndexMap:
      return checkIndexMap(member, value, element, path);
    case Form::IndexMaps:
      return forEach(value, element, path,
                     [&](json& item, const std::string& at) { checkIndexMap(member, item, element, at); });
    case Form::Integer:
      return checkInteger(member, value, element, path);
    case Form::Number:
      return checkNumber(member, value, element, path);
    case Form::Numbers:
      return checkNumbers(member, value, element, path);
    case Form::Flag:
      if (!value.is_boolean()) refuse(element, path, "is neither true nor false");
      return;
    case Form::Text:
      return checkText(member, value, element, path);
    case Form::Texts:
      return forEach(value, element, path,
                     [&](json& item, const std::string& at) { checkText(member, item, element, at); });
    case Form::Code:
      return checkCode(member, value, element, path);
    case Form::Object:
      return checkObject(value, std::string(member.detail), element, path);
    case Form::Objects:
      return checkObjects(member, value, element, path);
    }
  }

  template <typename Check>
  void forEach(json& value, const std::string& element, const std::string& path, const Check& check) const {
    if (!value.is_array()) refuse(element, path, fmt::format("is a JSON {}, not an array", value.type_name()));
    std::size_t i = 0;
    for (json& item : value) check(item, fmt::format("{}[{}]", path, i++));
  }

  void checkObjects(const Member& member, json& value, const std::string& element, const std::string& path) {
    std::size_t i = 0;
    forEach(value, element, path, [&](json& item, const std::string& at) {
      if (!element.empty()) return checkObject(item, std::string(member.detail), element, at);
      std::string_view name;
      if (item.is_object() && item.contains("name") && item["name"].is_string())
        name = item["name"].get_ref<const std::string&>();
      checkObject(item, std::string(member.detail), elementLabel(member.detail, i++, name), "");
    });
  }

  void checkInteger(const Member& member, json& value, const std::string& element, const std::string& path) const {
    if (!value.is_number()) refuse(element, path, fmt::format("is a JSON {}, not an integer", value.type_name()));
    const double number = value.get<double>();
    if (number != std::floor(number) || std::abs(number) > kMostBytes)
      refuse(element, path, fmt::format("{} is not an integer", value.dump()));
    if (number < member.least || number > member.most)
      refuse(element, path, fmt::format("{} is out of range [{}, {}]", value.dump(), member.least, member.most));
    if (value.is_number_float()) value = static_cast<std::int64_t>(number);
  }

  void checkIndex(const Member& member, json& value, const std::string& element, const std::string& path) const {
    Member bounds = member;
    bounds.least = -kMostBytes, bounds.most = kMostBytes;
    checkInteger(bounds, value, element, path);
    const std::size_t count = targetCount(member.detail);
    const std::int64_t index = value.get<std::int64_t>();
    if (index < 0 || static_cast<std::uint64_t>(index) >= count)
      refuse(element, path, fmt::format("{} does not exist, the file has {} {}", index, count, member.detail));
  }

  void checkIndices(const Member& member, json& value, const std::string& element, const std::string& path) const {
    std::vector<bool> seen(targetCount(member.detail), false);
    forEach(value, element, path, [&](json& item, const std::string& at) {
      checkIndex(member, item, element, at);
      const auto index = item.get<std::size_t>();
      if (seen[index]) refuse(element, at, fmt::format("{} stands there twice", index));
      seen[index] = true;
    });
  }

  void checkIndexMap(const Member& member, json& value, const std::string& element, const std::string& path) const {
    if (!value.is_object()) refuse(element, path, fmt::format("is a JSON {}, not an object", value.type_name()));
    for (auto& [name, item] : value.items()) checkIndex(member, item, element, fmt::format("{}.{}", path, name));
  }

  void checkNumber(const Member& member, json& value, const std::string& element, const std::string& path) const {
    if (!value.is_number()) refuse(element, path, fmt::format("is a JSON {}, not a number", value.type_name()));
    const double number = value.get<double>();
    if (!std::isfinite(number)) refuse(element, path, "is not finite");
    if (number < member.least || number > member.most)
      refuse(element, path, fmt::format("{} is out of range", value.dump()));
  }

  void checkNumbers(const Member& member, json& value, const std::string& element, const std::string& path) const {
    forEach(value, element, path, [&](json& item, const std::string& at) { checkNumber(member, item, element, at); });
    if (member.length != 0 && value.size() != member.length)
      refuse(element, path, fmt::format("has {} numbers, not {}", value.size(), member.length));
  }

  void checkText(const Member& member, const json& value, const std::string& element, const std::string& path) const {
    if (!value.is_string()) refuse(element, path, fmt::format("is a JSON {}, not a string", value.type_name()));
    if (!member.detail.empty() && !isOneOf(member.detail, value.get_ref<const std::string&>()))
      refuse(element, path, fmt::format("\"{}\" is none of {}", value.get_ref<const std::string&>(), member.detail));
  }

  void checkCode(const Member& member, json& value, const std::string& element, const std::string& path) const {
    Member bounds = member;
    bounds.least = 0, bounds.most = kMostInt;
    checkInteger(bounds, value, element, path);
    if (!isOneOf(member.detail, std::to_string(value.get<std::int64_t>())))
      refuse(element, path, fmt::format("{} is none of {}", value.dump(), member.detail));
  }

  static bool isOneOf(std::string_view choices, std::string_view text) {
    while (true) {
      const std::size_t bar = choices.find('|');
      if (choices.substr(0, bar) == text) return true;
      if (bar == std::string_view::npos) return false;
      choices.remove_prefix(bar + 1);
    }
  }

  json& document_;
  std::string_view file_;
  std::map<std::string, std::vector<const Member*>, std::less<>> members_;
};

} // namespace

std::string elementLabel(std::string_view kind, std::size_t index, std::string_view name) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} \"{}\"", kind, index, name);
}

void checkGltfSchema(json& document, std::string_view file) { Walker(document, file).walk(); }

} // namespace brickfield
