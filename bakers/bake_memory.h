// What a bake will take of memory, known before it is taken: a level asks once its bricks are counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace brickfield {

class BakeMemory {
public:
  /// limitBytes  0: as much as a field may have (kMaxFieldBytes)
  BakeMemory(std::string label, std::uint64_t limitBytes) : label_(std::move(label)), limitBytes_(limitBytes) {}

  /// What is there before the levels: triangles, their hierarchies and windings.
  void holdTriangles(std::size_t count);

  struct Level {
    std::size_t index = 0, bricks = 0, cells = 0;
    int surfaces = 1; ///< solids, sheets or both
    bool hasAttributes = false, keepsTriangles = false, growsSolids = false;
  };
  /// Counts a level in; those before it have left what they made.
  ///
  /// error BadInput that names the mesh and the level, with the bytes that are needed
  void admit(const Level& level);

  /// The most that was admitted.
  std::uint64_t peakBytes() const { return peakBytes_; }

private:
  std::string label_;
  std::uint64_t limitBytes_;
  std::uint64_t triangleBytes_ = 0, fieldBytes_ = 0, peakBytes_ = 0;
};

/// At most so many bytes does a bake of the resolution take, whatever the mesh: its surface in every brick.
std::uint64_t mostBakeBytes(int resolution, std::size_t triangles);

} // namespace brickfield
