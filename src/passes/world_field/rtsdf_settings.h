// The parameters of the RTSDF paper (Tan, Chua, Koh and Bhojan 2022), with its values as defaults. Lengths are in the
// paper's normalised scene, of which it says no more than that its scene is small: here 1 is the side of the field's
// box, so that a length is a share of the fine texels along it. That fits the paper's figures: the coarse texel of size
// S is 1/64 = 0.016; with d = 0.05, three of them, it sees holes and with d = 0.1, six, none; and its largest step of
// 0.05 needs the 128 reads it names to cross a box of diagonal sqrt(3) with room for shorter steps.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <glm/glm.hpp>

namespace brickfield {

struct RtsdfSettings {
  int coarseSize = 128;      ///< texels along a side: a power of two, 8 to 512
  int fineSize = 256;        ///< the same, 8 to 512
  int raysPerTexel = 5;      ///< x, 0 to 64; with 5 the paper's tables 1 and 3 agree
  float decay = 0.95f;       ///< alpha: what stays of the last frame's field, 0 to 1
  float maskWidth = 0.1f;    ///< d, at least 0; infinity sends rays from every texel
  std::optional<float> beta; ///< subtracted from coarse distances, at least 0; nothing: see rtsdfBeta
  float bias = 0.01f;        ///< subtracted from the finished field, at least 0 (the paper's section 2.5.3)
  std::uint32_t seed = 1;    ///< of the directions
  bool bruteForce = false;   ///< section 2.1: rays from every texel of bruteExtent, the least distance and all votes
                             ///< kept over frames; no coarse field, no decay
  glm::ivec3 bruteExtent{400, 200, 400}; ///< texels, each 8 to 512
};

/// Table 2: "S" 64 and 128, "M" 128 and 256, "L" 256 and 512.
/// error BadInput for any other name
void setRtsdfSize(RtsdfSettings& settings, std::string_view name);

/// The beta that the paper calls small and does not give: a tenth of a coarse texel unless set. Any below a whole one
/// makes the seeds and nothing else negative, which is its purpose. From half a one on, coarse distances to a flat wall
/// would nowhere be longer than the truth, and no ray would ever change the minimum: the least kind reading.
float rtsdfBeta(const RtsdfSettings& settings);

/// Texels of the field.
glm::ivec3 rtsdfExtent(const RtsdfSettings& settings);

/// error BadInput, which names the parameter: out of the ranges above
void checkRtsdfSettings(const RtsdfSettings& settings);

} // namespace brickfield
