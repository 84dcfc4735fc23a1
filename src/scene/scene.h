// The scene as plain data: what a glTF file says, checked and completed (normals, tangents), or what a host builds by
// hand. No GL, no file access. Indices are into the scene's own arrays; -1 means none. Everything that an importer
// hands out is in range, finite and free of cycles.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/math.h"

namespace brickfield {

struct Image {
  std::string name;
  glm::uvec2 size{0};             ///< pixels
  std::vector<std::uint8_t> rgba; ///< 8 bits a channel, rows from the top (v = 0 is the first row)
};

enum class Wrap : std::uint8_t { Repeat, ClampToEdge, MirroredRepeat };
enum class Filter : std::uint8_t { Nearest, Linear };

/// An image with the way to sample it ("texture" in glTF; the GPU room has a Texture of its own).
struct SceneTexture {
  int image = -1;
  Wrap wrapU = Wrap::Repeat;
  Wrap wrapV = Wrap::Repeat;
  Filter magnify = Filter::Linear;
  Filter minify = Filter::Linear;
  std::optional<Filter> mipmap = Filter::Linear; ///< nothing: only the full-size image is sampled
};

/// A use of a texture by a material.
struct TextureSlot {
  int texture = -1;
  int uvSet = 0;                 ///< 0 or 1
  glm::mat3 textureFromUv{1.0f}; ///< KHR_texture_transform, applied to (u, v, 1)
  bool isUsed() const { return texture >= 0; }
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

struct Material {
  std::string name;
  glm::vec4 baseColor{1.0f}; ///< linear, times texture, times vertex colour
  float metallic = 1.0f;
  float roughness = 1.0f;
  glm::vec3 emission{0.0f}; ///< linear, emissive strength multiplied in
  float normalScale = 1.0f;
  float occlusionStrength = 1.0f;
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f; ///< Mask; Blend is drawn as a mask at 0.5 in the opaque frame
  bool doubleSided = false;
  bool unlit = false;
  float diffuseTransmission = 0;            ///< share of the diffuse light that passes to the other side
  glm::vec3 diffuseTransmissionColor{1.0f}; ///< linear
  glm::vec3 absorption{0.0f};               ///< per metre of the inside
  TextureSlot baseColorTexture;             ///< sRGB, alpha linear
  TextureSlot metallicRoughnessTexture;     ///< linear: G roughness, B metallic
  TextureSlot normalTexture;                ///< linear tangent space
  TextureSlot occlusionTexture;             ///< linear: R
  TextureSlot emissionTexture;              ///< sRGB
};

/// Offsets from the base; an array is empty or as long as the positions.
struct MorphTarget {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> tangents;
};

/// Triangles of one material in object space. All vertex arrays have the length of `positions`, the optional ones
/// may be empty instead.
struct Primitive {
  std::vector<std::uint32_t> indices; ///< three a triangle, counter-clockwise seen from the front
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;            ///< always there, unit
  std::vector<glm::vec4> tangents;           ///< xyz unit, w = handedness; empty where no normal map needs them
  std::array<std::vector<glm::vec2>, 2> uvs; ///< optional
  std::vector<glm::vec4> colors;             ///< optional, linear
  int influencesPerVertex = 0;               ///< 0, 4 or 8: entries a vertex in joints and jointWeights
  std::vector<std::uint16_t> joints;         ///< into Skin::joints
  std::vector<float> jointWeights;           ///< sums to 1 for each vertex
  std::vector<MorphTarget> morphTargets;
  bool flatNormals = false; ///< the file had no normals: shade with the triangle's own, also deformed
  int material = -1;        ///< -1: the default Material
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives; ///< triangles only
  std::vector<float> morphWeights;   ///< defaults; every primitive has as many targets
};

enum class SignMethod : std::uint8_t { Auto, Winding, Parity, Pseudonormal, TwoSided };

/// What a node's extras.brickfield say; absent members take the command line's value, then the default.
struct SdfSettings {
  bool sdf = false;
  std::optional<int> resolution; ///< voxels along the longest side, 8 to 1024
  std::optional<int> bits;       ///< 8 or 16
  std::optional<SignMethod> sign;
  std::optional<float> thickness;      ///< metres of object space, two-sided only
  std::optional<float> opacity;        ///< 0 to 1
  std::optional<glm::vec3> absorption; ///< per metre, each >= 0
  std::optional<float> triplanar;      ///< metres of object space that its textures span, projected along its axes
};

struct Node {
  std::string name;
  int parent = -1;
  std::vector<int> children;
  std::optional<glm::mat4> matrix; ///< if absent: translation * rotation * scale
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};
  int mesh = -1;
  int skin = -1;
  int camera = -1;
  int light = -1;
  std::vector<float> morphWeights;         ///< empty: the mesh's
  std::vector<glm::mat4> nodeFromInstance; ///< EXT_mesh_gpu_instancing; empty: one instance, identity
  SdfSettings sdf;
};

struct Skin {
  std::string name;
  std::vector<int> joints;              ///< nodes
  std::vector<glm::mat4> jointFromBind; ///< inverse bind matrices, as many as joints
};

enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };
enum class AnimatedProperty : std::uint8_t { Translation, Rotation, Scale, MorphWeights };

struct AnimationChannel {
  int node = -1;
  AnimatedProperty property = AnimatedProperty::Translation;
  Interpolation interpolation = Interpolation::Linear;
  int components = 3;         ///< floats a value: 3, 4 (quaternion x,y,z,w) or the number of weights
  std::vector<float> seconds; ///< strictly increasing, first >= 0
  std::vector<float> values;  ///< a key: one value; CubicSpline: in-tangent, value, out-tangent
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
};

struct Camera {
  std::string name;
  bool orthographic = false;
  float verticalFovRadians = 0.8f;
  std::optional<float> aspect;      ///< width / height; nothing: the image's
  float nearDistance = 0.01f;       ///< metres
  std::optional<float> farDistance; ///< nothing: infinite
  glm::vec2 halfExtent{1.0f};       ///< orthographic: metres
};

enum class LightKind : std::uint8_t { Sun, Point, Spot, Sphere, Rectangle };

/// Shines along its own -Z. Units as in KHR_lights_punctual: lux for suns, candela for the others; those of a rectangle
/// leave along its -Z, and by the cosine less aside: it is of one radiance on its front, dark on its back.
struct Light {
  std::string name;
  LightKind kind = LightKind::Point;
  glm::vec3 color{1.0f}; ///< linear
  float intensity = 1.0f;
  float range = 0.0f; ///< metres, 0: infinite
  float innerConeRadians = 0.0f;
  float outerConeRadians = 0.7853982f;
  float radius = 0.0f;       ///< Sphere: metres
  float angleRadians = 0.0f; ///< Sun: diameter of the disk
  glm::vec2 size{0.0f};      ///< Rectangle: metres along its own X and Y
};

/// One of the file's scenes: the roots that are shown.
struct SceneRoots {
  std::string name;
  std::vector<int> nodes;
};

struct Scene {
  std::string name;                         ///< of the file as the caller wrote it, for messages
  std::vector<std::filesystem::path> files; ///< beside it: of all buffers and images; nobody may write there
  std::vector<Image> images;
  std::vector<SceneTexture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<SceneRoots> scenes;
  int defaultScene = 0;              ///< -1: no scene at all, nothing is shown
  std::vector<std::string> warnings; ///< what was left out or repaired, a line each
};

/// "node 3 \"Arm\"": how messages name a node.
std::string nodeLabel(const Scene& scene, int node);

/// The material of a primitive, the glTF default one where it names none.
const Material& materialOf(const Scene& scene, const Primitive& primitive);

} // namespace brickfield
