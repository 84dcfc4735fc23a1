// FrameLayers as one multi-part EXR, the file of --layers.
#pragma once

#include <filesystem>

#include "scene/frame_layers.h"

namespace brickfield {

/// Writes the layers that are made, a part each: color (R G B), depth (Z), normal and normal_surface (X Y Z),
/// albedo (R G B), id (ID), kind (KIND), ao (AO), steps (STEPS), and a part a light, shadow, shadow_1, ... (V); 32-bit
/// floats, which hold node numbers exactly up to 2^24.
///
/// error     BadInput: the path cannot be written; Failure: a layer whose length is not the size's, or no layer
/// proved by tests/unit/app/layers_io_test.cpp
void writeLayers(const std::filesystem::path& path, const FrameLayers& layers);

/// The same back. A file of one unnamed R G B part is its color layer; parts of other names are left out.
/// error  BadInput that names file and part: damaged, channels missing, sizes that differ, no known part, an id or kind
///        that is no whole number in range
FrameLayers readLayers(const std::filesystem::path& path);

} // namespace brickfield
