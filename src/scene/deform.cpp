// Morph targets, then linear blend skinning, on the CPU (glTF 2.0, 3.7.2.2 and 3.7.3.3). Twin of the GPU's deform pass.
//
//   bind space --morph--> bind space --sum of weight * worldFromBind--> world       skinned
//   object     --morph--> object                                                    rigid
#include "scene/deform.h"

#include <algorithm>

namespace brickfield {

namespace {

bool isSkinned(const Primitive& primitive, const PosedInstance& instance) {
  return primitive.influencesPerVertex > 0 && !instance.worldFromBind.empty();
}

glm::mat4 blendedJointMatrix(const Primitive& primitive, const PosedInstance& instance, std::size_t vertex) {
  const auto influences = static_cast<std::size_t>(primitive.influencesPerVertex);
  glm::mat4 worldFromBind(0.0f);
  for (std::size_t i = vertex * influences; i < (vertex + 1) * influences; ++i)
    if (primitive.jointWeights[i] != 0.0f)
      worldFromBind += primitive.jointWeights[i] * instance.worldFromBind[primitive.joints[i]];
  return worldFromBind;
}

/// Adds the weighted offsets that `offsetsOf` picks from each target.
template <typename OffsetsOf>
void addMorphs(const Primitive& primitive, const PosedInstance& instance, OffsetsOf offsetsOf,
               std::vector<glm::vec3>& values) {
  const std::size_t count = std::min(primitive.morphTargets.size(), instance.morphWeights.size());
  for (std::size_t target = 0; target < count; ++target) {
    const float weight = instance.morphWeights[target];
    const std::vector<glm::vec3>& offsets = offsetsOf(primitive.morphTargets[target]);
    if (weight == 0.0f || offsets.empty()) continue;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * offsets[i];
  }
}

glm::vec3 unitOr(glm::vec3 direction, glm::vec3 fallback) {
  const float length = glm::length(direction);
  return length > 0.0f && std::isfinite(length) ? direction / length : fallback;
}

/// Each vertex gets the area-weighted sum of its triangles: the triangle's own normal where vertices are not shared.
void recomputeFlatNormals(const Primitive& primitive, DeformedPrimitive& deformed) {
  std::vector<glm::vec3> sums(deformed.positions.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    const std::uint32_t* v = &primitive.indices[i];
    const glm::vec3 areaNormal = glm::cross(deformed.positions[v[1]] - deformed.positions[v[0]],
                                            deformed.positions[v[2]] - deformed.positions[v[0]]);
    for (int corner = 0; corner < 3; ++corner) sums[v[corner]] += areaNormal;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) deformed.normals[i] = unitOr(sums[i], deformed.normals[i]);
}

} // namespace

std::vector<glm::vec3> deformPositions(const Primitive& primitive, const PosedInstance& instance) {
  std::vector<glm::vec3> positions = primitive.positions;
  addMorphs(
      primitive, instance, [](const MorphTarget& t) -> const auto& { return t.positions; }, positions);
  if (isSkinned(primitive, instance))
    for (std::size_t i = 0; i < positions.size(); ++i)
      positions[i] = transformPoint(blendedJointMatrix(primitive, instance, i), positions[i]);
  return positions;
}

DeformedPrimitive deformPrimitive(const Primitive& primitive, const PosedInstance& instance) {
  DeformedPrimitive deformed;
  deformed.positions = deformPositions(primitive, instance);
  deformed.normals = primitive.normals;
  addMorphs(
      primitive, instance, [](const MorphTarget& t) -> const auto& { return t.normals; }, deformed.normals);
  std::vector<glm::vec3> tangents(primitive.tangents.begin(), primitive.tangents.end());
  addMorphs(
      primitive, instance, [](const MorphTarget& t) -> const auto& { return t.tangents; }, tangents);

  // The cofactor matrix carries cross(e1, e2) to cross(M e1, M e2): normals stay on the side that the winding says,
  // even where a joint mirrors.
  const bool skinned = isSkinned(primitive, instance);
  for (std::size_t i = 0; i < deformed.normals.size(); ++i) {
    const glm::mat4 worldFromBind = skinned ? blendedJointMatrix(primitive, instance, i) : glm::mat4(1.0f);
    deformed.normals[i] = unitOr(normalMatrix(worldFromBind) * deformed.normals[i], primitive.normals[i]);
    if (!tangents.empty())
      deformed.tangents.emplace_back(
          unitOr(transformDirection(worldFromBind, tangents[i]), glm::vec3(primitive.tangents[i])),
          primitive.tangents[i].w);
  }
  if (primitive.flatNormals && isDeformed(primitive, instance)) recomputeFlatNormals(primitive, deformed);
  return deformed;
}

bool isDeformed(const Primitive& primitive, const PosedInstance& instance) {
  if (isSkinned(primitive, instance)) return true;
  const std::size_t count = std::min(primitive.morphTargets.size(), instance.morphWeights.size());
  for (std::size_t target = 0; target < count; ++target)
    if (instance.morphWeights[target] != 0.0f && !primitive.morphTargets[target].positions.empty()) return true;
  return false;
}

} // namespace brickfield
