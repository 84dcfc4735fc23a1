// A primitive goes through: attributes, influences, morph targets, indices, normals, tangents; in this order, because
// making normals may un-index and making tangents may split what was read before.
#include "scene/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_accessor.h"
#include "scene/gltf_schema.h"
#include "scene/primitive_build.h"
#include "scene/tangents.h"

namespace brickfield {

namespace {

using AttributeMap = std::map<std::string, int>;

std::optional<int> find(const AttributeMap& attributes, const std::string& name) {
  const auto it = attributes.find(name);
  return it == attributes.end() ? std::nullopt : std::optional<int>(it->second);
}

template <typename Vector>
std::vector<Vector> asVectors(const std::vector<float>& numbers) {
  constexpr auto kWidth = static_cast<std::size_t>(Vector::length());
  std::vector<Vector> vectors(numbers.size() / kWidth);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    vectors[i / kWidth][static_cast<glm::length_t>(i % kWidth)] = numbers[i];
  return vectors;
}

// Component types that the core specification allows, and those that KHR_mesh_quantization adds.
struct Encoding {
  std::string_view types;
  std::string_view core;
  std::string_view quantized;
};
constexpr Encoding kPosition = {"VEC3", "f32", " i8 i8n u8 u8n i16 i16n u16 u16n"};
constexpr Encoding kNormal = {"VEC3", "f32", " i8n i16n"};
constexpr Encoding kTangent = {"VEC4", "f32", " i8n i16n"};
constexpr Encoding kUv = {"VEC2", "f32 u8n u16n", " i8 i8n u8 i16 i16n u16"};
constexpr Encoding kColor = {"VEC3|VEC4", "f32 u8n u16n", ""};
constexpr Encoding kJoints = {"VEC4", "u8 u16", ""};
constexpr Encoding kWeights = {"VEC4", "f32 u8n u16n", ""};
constexpr Encoding kMorphPosition = {"VEC3", "f32", " i8 i8n i16 i16n"};
constexpr Encoding kMorphDirection = {"VEC3", "f32", " i8n i16n"};

class PrimitiveReader {
public:
  PrimitiveReader(GltfDocument& document, const Scene& scene, const MeshUse& use, const tinygltf::Primitive& source,
                  std::string element)
      : document_(document),
        scene_(scene),
        use_(use),
        source_(source),
        element_(std::move(element)),
        isQuantized_(document.uses("KHR_mesh_quantization")) {}

  /// Nothing for what is no surface: points, lines, primitives without positions.
  std::optional<Primitive> read() {
    if (source_.mode < TINYGLTF_MODE_TRIANGLES) {
      checkUndrawnIndices();
      warn(source_.mode == TINYGLTF_MODE_POINTS ? "points are left out" : "lines are left out");
      return std::nullopt;
    }
    const std::optional<int> position = find(source_.attributes, "POSITION");
    if (!position) {
      warn("has no POSITION and is left out");
      return std::nullopt;
    }
    vertexCount_ = accessorCount(document_, *position);
    document_.spendVertices(vertexCount_ * (1 + source_.targets.size()), element_);
    primitive_.material = source_.material;
    primitive_.positions = attribute<glm::vec3>("POSITION", kPosition);
    primitive_.normals = attribute<glm::vec3>("NORMAL", kNormal);
    readTangents();
    primitive_.uvs = {attribute<glm::vec2>("TEXCOORD_0", kUv), attribute<glm::vec2>("TEXCOORD_1", kUv)};
    readColors();
    readInfluences();
    readMorphTargets();
    reportUnread();
    readIndices();
    completeNormals();
    completeTangents();
    checkUvSets();
    return std::move(primitive_);
  }

private:
  void warn(std::string_view text) { document_.warnings.push_back(fmt::format("{}: {}", element_, text)); }

  AccessorFormat formatOf(const Encoding& encoding) const {
    return {std::string(encoding.types),
            std::string(encoding.core) + (isQuantized_ ? std::string(encoding.quantized) : "")};
  }

  void checkAttribute(int accessor, const Encoding& encoding, const std::string& name) const {
    const std::string user = fmt::format("{}: {}", element_, name);
    checkFormat(document_, accessor, formatOf(encoding), user);
    if (const std::uint64_t count = accessorCount(document_, accessor); count != vertexCount_)
      document_.refuse(user, fmt::format("has {} elements, POSITION has {}", count, vertexCount_));
  }

  template <typename Vector>
  std::vector<Vector> attribute(const std::string& name, const Encoding& encoding) const {
    const std::optional<int> accessor = find(source_.attributes, name);
    if (!accessor) return {};
    checkAttribute(*accessor, encoding, name);
    return asVectors<Vector>(readFloats(document_, *accessor));
  }

  void readTangents() {
    const std::optional<int> accessor = find(source_.attributes, "TANGENT");
    if (accessor && accessorIsEmpty(document_, *accessor)) return warn("TANGENT has no data and is left out");
    primitive_.tangents = attribute<glm::vec4>("TANGENT", kTangent);
  }

  void readColors() {
    const std::optional<int> accessor = find(source_.attributes, "COLOR_0");
    if (!accessor) return;
    checkAttribute(*accessor, kColor, "COLOR_0");
    const std::vector<float> numbers = readFloats(document_, *accessor);
    if (accessorComponents(document_, *accessor) == 4)
      primitive_.colors = asVectors<glm::vec4>(numbers);
    else
      for (const glm::vec3& color : asVectors<glm::vec3>(numbers)) primitive_.colors.emplace_back(color, 1.0f);
    bool isClamped = false;
    for (glm::vec4& color : primitive_.colors) {
      glm::vec4 clamped = glm::max(color, glm::vec4(0.0f));
      clamped.w = std::min(clamped.w, 1.0f);
      isClamped |= clamped != color;
      color = clamped;
    }
    if (isClamped) warn("COLOR_0 is clamped: negative colours, alpha outside of [0,1]");
  }

  void readInfluences() {
    int sets = 0;
    for (int set = 0; set < 2; ++set) {
      const bool hasJoints = source_.attributes.contains(fmt::format("JOINTS_{}", set));
      const bool hasWeights = source_.attributes.contains(fmt::format("WEIGHTS_{}", set));
      if (hasJoints != hasWeights)
        document_.refuse(element_, fmt::format("has only one of JOINTS_{0} and WEIGHTS_{0}", set));
      if (hasJoints && sets == set) ++sets;
    }
    if (use_.isSkinned && sets == 0) document_.refuse(element_, "a node draws it with a skin, but it has no JOINTS_0");
    if (sets == 0) return;
    const std::size_t width = 4 * static_cast<std::size_t>(sets);
    std::vector<std::uint16_t> joints(vertexCount_ * width);
    std::vector<float> weights(vertexCount_ * width);
    for (int set = 0; set < sets; ++set) {
      const std::string jointsName = fmt::format("JOINTS_{}", set), weightsName = fmt::format("WEIGHTS_{}", set);
      const int jointAccessor = *find(source_.attributes, jointsName),
                weightAccessor = *find(source_.attributes, weightsName);
      checkAttribute(jointAccessor, kJoints, jointsName);
      checkAttribute(weightAccessor, kWeights, weightsName);
      const std::vector<std::uint32_t> setJoints = readIntegers(document_, jointAccessor);
      const std::vector<float> setWeights = readFloats(document_, weightAccessor);
      for (std::size_t i = 0; i < setJoints.size(); ++i) {
        const std::size_t slot = i / 4 * width + 4 * static_cast<std::size_t>(set) + i % 4;
        joints[slot] = static_cast<std::uint16_t>(setJoints[i]);
        weights[slot] = setWeights[i];
      }
    }
    // Without a skin nobody knows what the joints mean.
    if (!use_.isSkinned) return;
    primitive_.influencesPerVertex = static_cast<int>(width);
    primitive_.joints = std::move(joints);
    primitive_.jointWeights = std::move(weights);
    normalizeInfluences();
  }

  void normalizeInfluences() {
    const auto width = static_cast<std::size_t>(primitive_.influencesPerVertex);
    std::uint64_t unweighted = 0, rescaled = 0;
    // Eight weights of eight bits each may miss 1 by 8 * 0.5 / 255.
    constexpr float kQuantization = 0.016f;
    for (std::size_t v = 0; v < vertexCount_; ++v) {
      float* const weights = primitive_.jointWeights.data() + v * width;
      std::uint16_t* const joints = primitive_.joints.data() + v * width;
      double sum = 0.0;
      for (std::size_t k = 0; k < width; ++k) {
        if (weights[k] < 0.0f)
          document_.refuse(element_, fmt::format("vertex {} has the negative weight {}", v, weights[k]));
        if (weights[k] > 0.0f && joints[k] >= use_.jointLimit)
          document_.refuse(element_, fmt::format("vertex {} names joint {}, a skin that uses it has {}", v, joints[k],
                                                 use_.jointLimit));
        if (weights[k] == 0.0f) joints[k] = 0;
        sum += static_cast<double>(weights[k]);
      }
      if (sum <= 0.0) {
        ++unweighted;
        weights[0] = 1.0f;
        continue;
      }
      if (std::abs(sum - 1.0) > static_cast<double>(kQuantization)) ++rescaled;
      for (std::size_t k = 0; k < width; ++k) weights[k] = static_cast<float>(static_cast<double>(weights[k]) / sum);
    }
    if (unweighted > 0) warn(fmt::format("{} vertices have no weights and follow the skin's first joint", unweighted));
    if (rescaled > 0) warn(fmt::format("the weights of {} vertices did not sum to 1 and were scaled", rescaled));
  }

  void readMorphTargets() {
    for (std::size_t t = 0; t < source_.targets.size(); ++t) {
      const AttributeMap& target = source_.targets[t];
      const auto offsets = [&](const std::string& name, const Encoding& encoding) -> std::vector<glm::vec3> {
        const std::optional<int> accessor = find(target, name);
        if (!accessor) return {};
        const std::string where = fmt::format("target {} {}", t, name);
        if (!source_.attributes.contains(name)) document_.refuse(element_, where + " has no base attribute");
        checkAttribute(*accessor, encoding, where);
        return asVectors<glm::vec3>(readFloats(document_, *accessor));
      };
      MorphTarget morph;
      morph.positions = offsets("POSITION", kMorphPosition);
      morph.normals = offsets("NORMAL", kMorphDirection);
      morph.tangents = offsets("TANGENT", kMorphDirection);
      primitive_.morphTargets.push_back(std::move(morph));
    }
  }

  void reportUnread() {
    static constexpr std::array<std::string_view, 10> kRead = {"POSITION",   "NORMAL",   "TANGENT",  "TEXCOORD_0",
                                                               "TEXCOORD_1", "COLOR_0",  "JOINTS_0", "JOINTS_1",
                                                               "WEIGHTS_0",  "WEIGHTS_1"};
    for (const auto& [name, accessor] : source_.attributes)
      if (!name.starts_with('_') && std::find(kRead.begin(), kRead.end(), name) == kRead.end())
        warn(fmt::format("attribute {} is left out", name));
    for (const AttributeMap& target : source_.targets)
      for (const auto& [name, accessor] : target)
        if (!name.starts_with('_') && name != "POSITION" && name != "NORMAL" && name != "TANGENT")
          return warn(fmt::format("morphed {} is left out", name));
  }

  std::vector<std::uint32_t> vertexRun() {
    std::vector<std::uint32_t> vertices;
    if (source_.indices < 0) {
      document_.spendIndices(3 * vertexCount_, element_);
      vertices.resize(vertexCount_);
      std::iota(vertices.begin(), vertices.end(), 0u);
      return vertices;
    }
    checkFormat(document_, source_.indices, {"SCALAR", "u8 u16 u32", false}, element_ + ": indices");
    // A strip has up to three times as many indices as a list.
    document_.spendIndices(3 * accessorCount(document_, source_.indices), element_);
    vertices = readIntegers(document_, source_.indices);
    checkRestart(vertices);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (vertices[i] >= vertexCount_)
        document_.refuse(element_,
                         fmt::format("index {} at {} is not below the vertex count {}", vertices[i], i, vertexCount_));
    return vertices;
  }

  // What is not drawn must be well-formed all the same.
  void checkUndrawnIndices() {
    const std::optional<int> position = find(source_.attributes, "POSITION");
    if (!position || source_.indices < 0) return;
    vertexCount_ = accessorCount(document_, *position);
    vertexRun();
  }

  void readIndices() {
    const std::vector<std::uint32_t> vertices = vertexRun();
    const bool isList = source_.mode == TINYGLTF_MODE_TRIANGLES;
    if (vertices.size() < 3 || (isList && vertices.size() % 3 != 0))
      warn(fmt::format("{} vertices do not make whole triangles, the rest is left out", vertices.size()));
    const TriangleTopology topology = isList                                         ? TriangleTopology::List
                                      : source_.mode == TINYGLTF_MODE_TRIANGLE_STRIP ? TriangleTopology::Strip
                                                                                     : TriangleTopology::Fan;
    primitive_.indices = triangleList(topology, vertices);
  }

  // The largest value of an index type restarts primitives in other APIs; glTF forbids it even where it is a vertex.
  void checkRestart(const std::vector<std::uint32_t>& vertices) const {
    const int type = document_.model->accessors[static_cast<std::size_t>(source_.indices)].componentType;
    const std::uint32_t restart = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 0xFFu
                                  : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 0xFFFFu
                                                                                   : 0xFFFFFFFFu;
    if (const auto it = std::find(vertices.begin(), vertices.end(), restart); it != vertices.end())
      document_.refuse(element_,
                       fmt::format("index {} at {} is the primitive restart value", restart, it - vertices.begin()));
  }

  void completeNormals() {
    if (primitive_.normals.empty()) {
      document_.spendVertices(primitive_.indices.size() * (1 + source_.targets.size()), element_);
      return makeFlat(primitive_);
    }
    const NormalRepair repair = repairNormals(primitive_);
    if (repair.rescaled > 0) warn(fmt::format("{} normals were not unit and are scaled", repair.rescaled));
    if (repair.replaced > 0) warn(fmt::format("{} normals were zero and are made from the triangles", repair.replaced));
  }

  void completeTangents() {
    if (primitive_.tangents.empty()) {
      const TextureSlot& normalMap = materialOf(scene_, primitive_).normalTexture;
      if (!normalMap.isUsed()) return;
      for (MorphTarget& target : primitive_.morphTargets) target.tangents.clear();
      document_.spendVertices(primitive_.indices.size(), element_);
      return makeTangents(primitive_, normalMap.uvSet);
    }
    std::uint64_t replaced = 0;
    constexpr float kTolerance = 0.01f; // of a normalized byte
    for (std::size_t v = 0; v < primitive_.tangents.size(); ++v) {
      glm::vec4& tangent = primitive_.tangents[v];
      if (std::abs(std::abs(tangent.w) - 1.0f) > kTolerance)
        document_.refuse(element_, fmt::format("TANGENT of vertex {} has w = {}, neither 1 nor -1", v, tangent.w));
      const float length = glm::length(glm::vec3(tangent));
      const bool isUsable = length > 0.0f && std::isfinite(length);
      if (!isUsable) ++replaced;
      tangent = glm::vec4(isUsable ? glm::vec3(tangent) / length : anyPerpendicular(primitive_.normals[v]),
                          tangent.w < 0.0f ? -1.0f : 1.0f);
    }
    if (replaced > 0) warn(fmt::format("{} tangents were zero and are replaced", replaced));
  }

  void checkUvSets() {
    const Material& material = materialOf(scene_, primitive_);
    const std::array<const TextureSlot*, 5> slots = {&material.baseColorTexture, &material.metallicRoughnessTexture,
                                                     &material.normalTexture, &material.occlusionTexture,
                                                     &material.emissionTexture};
    for (int set = 0; set < 2; ++set)
      if (primitive_.uvs[static_cast<std::size_t>(set)].empty() &&
          std::any_of(slots.begin(), slots.end(),
                      [&](const TextureSlot* slot) { return slot->isUsed() && slot->uvSet == set; }))
        warn(fmt::format("its material needs TEXCOORD_{}, which it lacks; the texture's corner is used", set));
  }

  GltfDocument& document_;
  const Scene& scene_;
  const MeshUse& use_;
  const tinygltf::Primitive& source_;
  std::string element_;
  bool isQuantized_ = false;
  std::uint64_t vertexCount_ = 0;
  Primitive primitive_;
};

} // namespace

void importMeshes(GltfDocument& document, const std::vector<MeshUse>& uses, Scene& scene) {
  for (std::size_t m = 0; m < document.model->meshes.size(); ++m) {
    const tinygltf::Mesh& source = document.model->meshes[m];
    const std::string element = elementLabel("mesh", m, source.name);
    if (source.primitives.empty()) document.refuse(element, "has no primitives");
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.name = source.name;
    const std::size_t targetCount = source.primitives[0].targets.size();
    for (std::size_t p = 0; p < source.primitives.size(); ++p) {
      const std::string primitiveElement = fmt::format("{} primitive {}", element, p);
      if (source.primitives[p].targets.size() != targetCount)
        document.refuse(primitiveElement, fmt::format("has {} morph targets, primitive 0 has {}",
                                                      source.primitives[p].targets.size(), targetCount));
      if (std::optional<Primitive> primitive =
              PrimitiveReader(document, scene, uses[m], source.primitives[p], primitiveElement).read())
        mesh.primitives.push_back(std::move(*primitive));
    }
    if (!source.weights.empty() && source.weights.size() != targetCount)
      document.refuse(element, fmt::format("has {} weights for {} morph targets", source.weights.size(), targetCount));
    mesh.morphWeights.assign(source.weights.begin(), source.weights.end());
    mesh.morphWeights.resize(targetCount, 0.0f);
  }
}

} // namespace brickfield
