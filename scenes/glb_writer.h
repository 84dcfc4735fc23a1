// Builds a glTF 2.0 binary (.glb) piece by piece: geometry, images, materials, nodes, skins, animations, cameras,
// lights. Knows the file format and nothing of what is drawn. Numbers handed out are glTF indices.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/shape.h"
#include "scenes/textures.h"

namespace brickfield::scenes {

/// A use of a texture; -1: none.
struct TextureUse {
  int texture = -1;
  int uvSet = 0;
  float scaleUv = 1.0f; ///< KHR_texture_transform where it is not 1
};

struct MaterialSpec {
  std::string name{};
  glm::vec3 baseColor{1.0f}; ///< linear
  float metallic = 0.0f;
  float roughness = 0.5f;
  glm::vec3 emission{0.0f};      ///< linear, components up to 1
  float emissionStrength = 1.0f; ///< KHR_materials_emissive_strength where it is not 1
  bool doubleSided = false;
  TextureUse baseColorTexture{};
  TextureUse metallicRoughnessTexture{};
  TextureUse normalTexture{};
  TextureUse occlusionTexture{};
  float normalScale = 1.0f;
};

struct NodeSpec {
  std::string name{};
  glm::vec3 translation{0.0f};
  glm::quat rotation{1, 0, 0, 0};
  glm::vec3 scale{1.0f};
  int mesh = -1;
  int skin = -1;
  int camera = -1;
  int light = -1;
  nlohmann::ordered_json extras{}; ///< written under "brickfield" where not null
};

/// Keys of one property of one node, linearly interpolated.
struct ChannelSpec {
  int node = -1;
  std::string path; ///< "translation", "rotation" (x, y, z, w), "scale" or "weights"
  std::vector<float> seconds;
  std::vector<float> values;
};

class GlbWriter {
public:
  GlbWriter();

  int addTexture(const std::string& name, const Png& png);
  int addMaterial(const MaterialSpec& spec);

  /// Stores a shape's arrays once; several meshes may use them with different materials.
  int addGeometry(const Shape& shape);
  /// geometryAndMaterial one pair a primitive; material -1: none
  int addMesh(const std::string& name, const std::vector<std::pair<int, int>>& geometryAndMaterial);

  /// parent -1: a root of the scene.
  int addNode(const NodeSpec& spec, int parent = -1);
  /// EXT_mesh_gpu_instancing: the node's mesh is drawn once for each entry.
  void addInstances(int node, const std::vector<glm::vec3>& translations, const std::vector<glm::quat>& rotations,
                    const std::vector<glm::vec3>& scales);
  int addCamera(const std::string& name, float verticalFovRadians, float nearDistance);
  /// light a KHR_lights_punctual object
  int addLight(const nlohmann::ordered_json& light);
  int addSkin(const std::string& name, const std::vector<int>& joints, const std::vector<glm::mat4>& jointFromBind);
  void setSkin(int node, int mesh, int skin);
  void addAnimation(const std::string& name, const std::vector<ChannelSpec>& channels);

  /// The whole file.
  std::vector<std::byte> finish();

private:
  int addView(const void* bytes, std::size_t size, std::optional<int> target);
  int addAccessor(int view, int componentType, std::size_t count, const char* type, bool normalized = false);
  int addFloats(const std::vector<float>& values, std::size_t perElement, const char* type, std::optional<int> target,
                bool withBounds);
  template <typename Vector>
  int addVectors(const std::vector<Vector>& values, const char* type, bool withBounds = false);
  int addIndices(const std::vector<std::uint32_t>& indices, std::size_t vertexCount);
  void useExtension(const std::string& name, bool required = false);
  nlohmann::ordered_json textureInfo(const TextureUse& use);

  nlohmann::ordered_json document_;
  std::vector<nlohmann::ordered_json> geometries_;
  std::vector<std::byte> bytes_;
};

/// Column-wise angle-axis shorthand: degrees about an axis that need not be unit.
glm::quat rotationAbout(glm::vec3 axis, float degrees);
/// Rotation that turns -Z towards a target, +Y up: how cameras and lights look.
glm::quat lookRotation(glm::vec3 from, glm::vec3 target);

} // namespace brickfield::scenes
