// `brickfield bench bake`: times of the baker by stage, its memory, its error against brute force, beside OpenVDB's
// meshToVolume in the same run, and beside the thesis' converter.
#pragma once
#ifdef BRICKFIELD_BAKERS

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace brickfield {

struct BakeBenchRequest {
  std::vector<std::filesystem::path> meshPaths;
  std::filesystem::path json; ///< empty: not asked for
  std::vector<int> resolutions{64, 128, 256};
  SignMethod sign = SignMethod::Auto;
  bool isJoined = false; ///< all meshes of a file as they stand in its scene, in one; else its largest
  int threads = 2;
  int repeats = 5;
  std::size_t errorSamples = 0; ///< 0: as many as take a second or two
  bool withFullBake = true;     ///< time a bake with attributes and mips as well
};

/// Measures, prints, writes the JSON.
/// error  BadInput, Cancelled
void runBakeBench(const BakeBenchRequest& request);

} // namespace brickfield
#endif
