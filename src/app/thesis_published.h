// The figures of the thesis of 2017 about rendering with distance fields alone, milliseconds at 1920x1080. Its scene is
// written by `brickfield_scenes thesis`.
#pragma once

#include <array>

namespace brickfield::published {

/// As printed there, on a GTX 980, by the number of objects: full-screen tracing with all its optimisations, shadows at
/// half and ambient occlusion at a quarter of the resolution; the frame with its shared fields. 0: not printed.
struct ThesisRow {
  int objects;
  double frame, instancedFrame, primary, boxes, shadow, occlusion;
};
inline constexpr std::array<ThesisRow, 5> kThesis{{{20, 8.97, 8.63, 3.93, 4.13, 2.49, 0.93},
                                                   {40, 11.1, 10.23, 4.52, 4.53, 3.77, 1.00},
                                                   {60, 13.83, 11.38, 4.96, 5.06, 6.02, 1.09},
                                                   {80, 20.05, 12.27, 6.35, 5.63, 10.4, 1.76},
                                                   {100, 28.27, 13.06, 7.82, 6.06, 0, 0}}};

/// Its own program, timed for this project on an NVIDIA H200: Blinn-Phong, without temporal antialiasing. 0: not timed.
struct ThesisProgramRow {
  int objects;
  double frame, primary, boxes, shadow, occlusion, shading;
};
inline constexpr std::array<ThesisProgramRow, 4> kThesisOnH200{{{15, 2.84, 0.350, 7.75, 0.17, 0.08, 1.26},
                                                                {20, 2.93, 0.369, 7.44, 0, 0, 0},
                                                                {60, 3.68, 0.464, 8.70, 0, 0, 0},
                                                                {100, 4.30, 0.601, 9.36, 1.14, 0.15, 1.38}}};

} // namespace brickfield::published
