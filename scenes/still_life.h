// Shared state of the demo's parts: the file being written and where things touch the floor. The parts are in
// still_life_room.cpp, still_life_objects.cpp and still_life_props.cpp.
#pragma once

#include <string>
#include <vector>

#include "scenes/glb_writer.h"

namespace brickfield::scenes {

/// Something round that stands on the floor or floats over it: what darkens the floor nearby.
struct Contact {
  glm::vec2 centerXz;
  float radius;
  float height = 0; ///< of its underside
};

/// Materials that several parts use.
struct SharedMaterials {
  int terrazzo = -1;
  int brass = -1;
  int copper = -1;
  int steel = -1;
};

/// The demo under construction.
struct StillLife {
  GlbWriter glb;
  SharedMaterials materials;
  std::vector<Contact> contacts;
  std::vector<ChannelSpec> channels; ///< of the one animation

  /// A mesh of one material.
  int mesh(const std::string& name, const Shape& shape, int material) {
    return glb.addMesh(name, {{glb.addGeometry(shape), material}});
  }
};

/// What a node's extras say to become an SDF object.
nlohmann::ordered_json sdfExtras(int resolution);

void addSharedMaterials(StillLife& scene);
void addTeapots(StillLife& scene);
void addSculptures(StillLife& scene);
void addTableware(StillLife& scene);
void addBooksAndLamp(StillLife& scene);
void addFlowers(StillLife& scene);
void addSpheres(StillLife& scene);
/// Last, because the floor needs all contacts.
void addRoom(StillLife& scene);
void addCamerasAndLights(StillLife& scene);

/// Keys that turn a node about an axis by one whole turn, after its rest rotation.
ChannelSpec spinChannel(int node, glm::quat rest, glm::vec3 axis, float secondsPerTurn);

} // namespace brickfield::scenes
