// The scenes that this program can write; each call gives the same bytes every time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace brickfield::scenes {

/// The still life that shows what Brickfield is: meshes and SDF objects in one depth buffer.
std::vector<std::byte> demoScene();

/// A mesh sphere and mesh ring that cut an SDF box and an SDF torus; for tests. Cameras "front" and "top".
std::vector<std::byte> interpenetrationScene();

/// `count` SDF objects of twelve small meshes, strewn at random over a cube whose side grows with the cube root of
/// count; one node a mesh, placed by EXT_mesh_gpu_instancing. Cameras "outside" and "inside".
std::vector<std::byte> stressScene(int count, std::uint64_t seed);

/// A hall with pillars, two statues and `count` - 2 figures, 3 to 100 objects in all, one light: the scene that the
/// thesis of 2017 was measured with, rebuilt with shapes of our own. Camera "thesis".
std::vector<std::byte> thesisScene(int count);

} // namespace brickfield::scenes
