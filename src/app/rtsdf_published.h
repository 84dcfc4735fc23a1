// The figures of the RTSDF paper (Tan, Chua, Koh and Bhojan 2022), as printed there: RTX 2080 Ti with hardware rays,
// The Modern Living Room, milliseconds. Its table 2 is setRtsdfSize.
#pragma once

#include <array>
#include <limits>
#include <string_view>

namespace brickfield::published {

/// Table 1: one directional light. The processor's times of the passes are of the frame's recording.
struct FrameRow {
  std::string_view pass;
  double cpu, gpu;
};
inline constexpr std::array<FrameRow, 7> kFrame{{{"G-buffer", 0.29, 1.05},
                                                 {"voxelization", 0.63, 0.93},
                                                 {"jump flood", 0.06, 2.09},
                                                 {"ray trace", 1.05, 4.60},
                                                 {"deferred lighting", 0.11, 1.28},
                                                 {"others", 7.42, 0.27},
                                                 {"total", 9.56, 10.22}}};
inline constexpr double kFramesPerSecond = 97;

/// Table 3: passes by size and rays a texel; lighting is of three lights.
inline constexpr std::array<int, 4> kSizeRays{0, 1, 5, 10};
struct SizeRow {
  std::string_view size;
  double voxelize, flood;
  std::array<double, 4> rays; ///< by kSizeRays
  double lighting;
};
inline constexpr std::array<SizeRow, 3> kSizes{{{"S", 0.49, 0.28, {0.14, 0.16, 0.71, 1.41}, 3.17},
                                                {"M", 0.49, 2.37, {0.55, 1.41, 4.51, 8.36}, 3.17},
                                                {"L", 1.12, 21.89, {3.98, 9.12, 26.56, 48.32}, 7.32}}};

/// Table 4: the ray pass at size M by rays a texel (rows) and mask width d (columns). The paper does not say of what
/// its times are; its row x = 10 at d = 0.1 is table 3's ray pass.
inline constexpr std::array<int, 4> kMaskRays{1, 5, 10, 15};
inline constexpr std::array<float, 5> kMaskWidths{0.01f, 0.05f, 0.1f, 0.5f, std::numeric_limits<float>::infinity()};
inline constexpr double kMasks[4][5] = {{0.8, 1.28, 1.63, 3.12, 4.08},
                                        {1.43, 3.17, 4.82, 11.71, 16.15},
                                        {2.18, 5.41, 8.36, 22.25, 30.69},
                                        {3.17, 7.7, 12.42, 32.7, 46.0}};

} // namespace brickfield::published
