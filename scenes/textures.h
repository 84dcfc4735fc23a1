// Procedural textures as PNG files in memory. Rows from the top, 8 bits a channel; base colours are sRGB, the others
// linear. All tile unless it is said.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/math.h"

namespace brickfield::scenes {

using Png = std::vector<std::byte>;

/// Evaluates a colour for every pixel, with `samples` x `samples` points each, and encodes it.
/// value  linear colour in [0,1] at (u, v); averaged before the encoding to sRGB
Png paintedPng(int width, int height, int samples, bool isSrgb, const std::function<glm::vec3(glm::vec2 uv)>& value);

/// Tangent-space normals (+X right, +Y up, as glTF has them) of a height field that tiles.
/// height  at (u, v), in units of the texture's side
Png normalPng(int width, int height, const std::function<float(glm::vec2 uv)>& heightAt);

/// Oak boards: twelve rows of boards with staggered joints. Occlusion, roughness and metallic share one map.
Png plankBaseColor(int size);
Png plankNormal(int size);
Png plankRoughness(int size);

/// Chips of four stones in a pale ground.
Png terrazzoBaseColor(int size);
/// Chips shine more than the ground between them.
Png terrazzoRoughness(int size);

/// Cobalt and gold on white glaze, laid out for teapotTextureRows. Wraps in u only.
Png glazeBaseColor(int size);
Png glazeMetallicRoughness(int size);

/// Linen: a weave of warp and weft.
Png linenNormal(int size);
/// Soft trowel marks.
Png plasterNormal(int size);
/// Turned metal: fine rings along v.
Png brushedRoughness(int size);
Png chequerBaseColor(int size, int columns, int rows, glm::vec3 light, glm::vec3 dark);

} // namespace brickfield::scenes
