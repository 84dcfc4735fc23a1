// What a bake is given. Like bake_cache.cpp it needs no Embree: builds without the baker read its cache with both.
#include "bakers/bake.h"

namespace brickfield {

BakeInput bakeInputOf(const Scene& scene, const PosedInstance& instance) {
  const Mesh& mesh = scene.meshes.at(static_cast<std::size_t>(instance.mesh));
  BakeInput input;
  input.label = nodeLabel(scene, instance.node);
  input.scene = &scene;
  for (const Primitive& primitive : mesh.primitives) {
    input.primitives.push_back(&primitive);
    input.positionsObject.push_back(isDeformed(primitive, instance) ? deformPrimitive(primitive, instance).positions
                                                                    : primitive.positions);
  }
  return input;
}

} // namespace brickfield
