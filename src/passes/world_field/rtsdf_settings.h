// The parameters of the RTSDF paper (Tan, Chua, Koh and Bhojan 2022), with its values as defaults. Lengths are in the
// paper's normalised scene, of which it says nothing but that its scene is small: here the field's box is [-1, 1]^3, so
// that a length of 2 is the texels along a side. Its table 4 tells: the time of its rays at d = 0.05 and 0.1, less that
// without rays, is 16 and 26 % of that with d infinite; of our field of the same room at the same size 17 and 28 % of
// the texels are that near if the side is 2, and 28 and 48 % if it is 1.
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
  bool signByVote = true;    ///< false: no sign but that of beta, hollow as the coarse field. Where rooms are single
                             ///< walls that face outwards (modern_living_room) the vote takes all of a room for an
                             ///< inside, and what stands in it is dark all around
  std::uint32_t seed = 1;    ///< of the directions
  bool bruteForce = false;   ///< section 2.1: rays from every texel of bruteExtent, the least distance and all votes
                             ///< kept over frames; no coarse field, no decay
  glm::ivec3 bruteExtent{400, 200, 400}; ///< texels, each 8 to 512

  bool operator==(const RtsdfSettings&) const = default;
};

/// Table 2: "S" 64 and 128, "M" 128 and 256, "L" 256 and 512.
/// error BadInput for any other name
void setRtsdfSize(RtsdfSettings& settings, std::string_view name);

/// The beta that the paper calls small and does not give: a tenth of a coarse texel unless set. Any below a whole one
/// makes the seeds and nothing else negative, which is its purpose. From half a one on, coarse distances to a flat wall
/// would nowhere be longer than the truth, and no ray would ever change the minimum: the least kind reading.
/// returns in the normalised scene, like all lengths here
float rtsdfBeta(const RtsdfSettings& settings);

/// Texels of the field.
glm::ivec3 rtsdfExtent(const RtsdfSettings& settings);

/// error BadInput, which names the parameter: out of the ranges above
void checkRtsdfSettings(const RtsdfSettings& settings);

} // namespace brickfield
