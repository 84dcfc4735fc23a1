// Surfaces by functions of (u, v). PNG through stb_image_write, whose bytes depend on the pixels only.
#include "scenes/textures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/gtc/constants.hpp>
#include <stb/stb_image_write.h>

#include "core/error.h"
#include "scenes/noise.h"

namespace brickfield::scenes {
namespace {

void appendBytes(void* context, void* bytes, int size) {
  auto* png = static_cast<Png*>(context);
  const auto* first = static_cast<const std::byte*>(bytes);
  png->insert(png->end(), first, first + size);
}

Png encodePng(int width, int height, const std::vector<std::uint8_t>& rgb) {
  Png png;
  if (!stbi_write_png_to_func(appendBytes, &png, width, height, 3, rgb.data(), 3 * width)) {
    throw Failure("a texture could not be encoded as PNG");
  }
  return png;
}

std::uint8_t unorm8(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

glm::vec3 srgbColor(int red, int green, int blue) { return linearFromSrgb(glm::vec3(red, green, blue) / 255.0f); }

/// Octaves of value noise, repeating with (u, v) in [0,1]^2.
float octaves(glm::vec2 uv, glm::ivec2 cells, int count, std::uint32_t seed) {
  float sum = 0;
  float weight = 0.5f;
  for (int i = 0; i < count; ++i) {
    sum += weight * valueNoise(uv * glm::vec2(cells), cells, seed + static_cast<std::uint32_t>(i));
    cells *= 2;
    weight *= 0.5f;
  }
  return sum / (1.0f - 2.0f * weight);
}

/// Steps down to few levels: invisible under the grain, and the PNG gets half as large.
float quantized(float value, int levels) {
  return std::round(value * static_cast<float>(levels)) / static_cast<float>(levels);
}

struct Plank {
  int row = 0;
  int board = 0;
  float grain = 0; ///< 0 to 1
  float edge = 0;  ///< distance from the nearest joint, in sides of the texture
};

Plank plankAt(glm::vec2 uv) {
  constexpr int kRows = 12;
  constexpr int kBoards = 2;
  Plank plank;
  float y = uv.y * kRows;
  plank.row = static_cast<int>(std::floor(y)) % kRows;
  float shifted = uv.x + cellNoise(plank.row, 0, 11);
  shifted -= std::floor(shifted);
  plank.board = static_cast<int>(shifted * kBoards) % kBoards;
  float inRow = y - std::floor(y);
  float inBoard = shifted * kBoards - std::floor(shifted * kBoards);
  plank.edge = std::min(std::min(inRow, 1 - inRow) / kRows, std::min(inBoard, 1 - inBoard) / kBoards);
  // Grain: streaks along the board, bent by a slower noise; every board is cut from another place of the tree.
  float place = 17.0f * cellNoise(plank.row, plank.board, 5);
  float bend = octaves(uv + glm::vec2(place, 0), {3, 18}, 2, 21);
  float rings =
      0.5f + 0.5f * std::sin(glm::two_pi<float>() *
                             (7.0f * inRow * (0.4f + cellNoise(plank.row, plank.board, 6)) + 5.0f * bend + place));
  float streaks = octaves(uv + glm::vec2(place, place), {10, 160}, 2, 22);
  plank.grain = 0.45f * rings + 0.55f * streaks;
  return plank;
}

float plankHeight(glm::vec2 uv) {
  Plank plank = plankAt(uv);
  float bevel = std::min(plank.edge / 0.0022f, 1.0f);
  return 0.0016f * (1 - (1 - bevel) * (1 - bevel)) + 0.00022f * plank.grain;
}

struct Chip {
  float inside = 0; ///< positive within a chip, in cells
  float pick = 0;   ///< 0 to 1, which stone
};

/// The chip at a place: cells of a jittered grid, each shrunk by a random amount.
Chip chipAt(glm::vec2 uv, int cells, std::uint32_t seed) {
  glm::vec2 p = uv * static_cast<float>(cells);
  glm::ivec2 home(glm::floor(p));
  float nearest = 9, second = 9, pick = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      glm::ivec2 cell = home + glm::ivec2(dx, dy);
      glm::ivec2 wrapped = ((cell % cells) + cells) % cells;
      glm::vec2 jitter(cellNoise(wrapped.x, wrapped.y, seed), cellNoise(wrapped.x, wrapped.y, seed + 1));
      // A chip is a hexagon with sides of unequal distance, turned at random.
      float turn = glm::two_pi<float>() * cellNoise(wrapped.x, wrapped.y, seed + 3);
      glm::vec2 away = glm::vec2(cell) + 0.15f + 0.7f * jitter - p;
      glm::vec2 turned(std::cos(turn) * away.x - std::sin(turn) * away.y,
                       std::sin(turn) * away.x + std::cos(turn) * away.y);
      float across = 0.5f * turned.x, up = 0.866f * turned.y;
      float distance = std::max({0.8f * std::abs(turned.x), (0.7f + 0.6f * jitter.x) * std::abs(across + up),
                                 (0.7f + 0.6f * jitter.y) * std::abs(across - up)});
      if (distance < nearest) {
        second = nearest, nearest = distance, pick = cellNoise(wrapped.x, wrapped.y, seed + 2);
      } else {
        second = std::min(second, distance);
      }
    }
  }
  float size = 0.10f + 0.26f * (pick * 7 - std::floor(pick * 7));
  return {std::min(size - nearest, 0.5f * (second - nearest) - 0.03f), pick};
}

float linenHeight(glm::vec2 uv) {
  constexpr int kThreads = 48;
  float x = uv.x * kThreads, y = uv.y * kThreads;
  float warp = std::abs(std::sin(glm::pi<float>() * x));
  float weft = std::abs(std::sin(glm::pi<float>() * y));
  bool warpOnTop = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0;
  return 0.0035f * (warpOnTop ? 0.7f * warp + 0.3f * weft : 0.3f * warp + 0.7f * weft);
}

} // namespace

Png paintedPng(int width, int height, int samples, bool isSrgb, const std::function<glm::vec3(glm::vec2 uv)>& value) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  const glm::vec2 oneOverSize(1.0f / static_cast<float>(width), 1.0f / static_cast<float>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::vec3 sum(0);
      for (int sample = 0; sample < samples * samples; ++sample) {
        glm::vec2 offset(sample % samples, sample / samples);
        sum += value((glm::vec2(x, y) + (offset + 0.5f) / static_cast<float>(samples)) * oneOverSize);
      }
      glm::vec3 color = glm::clamp(sum / static_cast<float>(samples * samples), 0.0f, 1.0f);
      if (isSrgb) color = srgbFromLinear(color);
      for (int channel = 0; channel < 3; ++channel) rgb.push_back(unorm8(color[channel]));
    }
  }
  return encodePng(width, height, rgb);
}

Png normalPng(int width, int height, const std::function<float(glm::vec2 uv)>& heightAt) {
  const glm::vec2 pixel(1.0f / static_cast<float>(width), 1.0f / static_cast<float>(height));
  return paintedPng(width, height, 1, false, [&](glm::vec2 uv) {
    auto at = [&](float dx, float dy) { return heightAt(glm::fract(uv + glm::vec2(dx, dy) * pixel)); };
    float slopeU = (at(1, 0) - at(-1, 0)) / (2 * pixel.x);
    float slopeV = (at(0, 1) - at(0, -1)) / (2 * pixel.y);
    // v runs down the image, glTF's +Y up.
    return 0.5f + 0.5f * glm::normalize(glm::vec3(-slopeU, slopeV, 1.0f));
  });
}

Png plankBaseColor(int size) {
  return paintedPng(size, size, 1, true, [](glm::vec2 uv) {
    Plank plank = plankAt(uv);
    float tone = 0.85f + 0.3f * cellNoise(plank.row, plank.board, 7);
    glm::vec3 wood = glm::mix(srgbColor(178, 132, 88), srgbColor(122, 80, 48), quantized(0.9f * plank.grain, 28));
    wood = glm::mix(wood, wood * glm::vec3(1.05f, 0.94f, 0.84f), cellNoise(plank.row, plank.board, 8)) * tone;
    return wood * (0.35f + 0.65f * std::min(plank.edge / 0.0016f, 1.0f));
  });
}

Png plankNormal(int size) { return normalPng(size, size, plankHeight); }

Png plankRoughness(int size) {
  return paintedPng(size, size, 1, false, [](glm::vec2 uv) {
    Plank plank = plankAt(uv);
    float roughness = 0.34f + 0.2f * quantized(plank.grain, 12) + 0.08f * cellNoise(plank.row, plank.board, 9);
    return glm::vec3(1.0f, roughness, 0.0f);
  });
}

Png terrazzoBaseColor(int size) {
  return paintedPng(size, size, 2, true, [](glm::vec2 uv) {
    const glm::vec3 stones[] = {srgbColor(190, 122, 98), srgbColor(92, 116, 120), srgbColor(204, 172, 122),
                                srgbColor(150, 146, 140)};
    glm::vec3 color = srgbColor(232, 226, 216);
    for (int layer = 0; layer < 2; ++layer) {
      Chip chip = chipAt(uv, layer == 0 ? 20 : 9, layer == 0 ? 101 : 131);
      bool isShown = layer == 0 || chip.pick < 0.6f;
      if (chip.inside > 0 && isShown) color = stones[static_cast<int>(chip.pick * 97) % 4];
    }
    return color;
  });
}

Png terrazzoRoughness(int size) {
  return paintedPng(size, size, 2, false, [](glm::vec2 uv) {
    bool isChip = chipAt(uv, 20, 101).inside > 0 || chipAt(uv, 9, 131).inside > 0;
    return glm::vec3(1.0f, isChip ? 0.28f : 0.5f, 0.0f);
  });
}

Png linenNormal(int size) { return normalPng(size, size, linenHeight); }

Png plasterNormal(int size) {
  return normalPng(size, size, [](glm::vec2 uv) { return 0.01f * octaves(uv, {6, 4}, 4, 41); });
}

Png brushedRoughness(int size) {
  return paintedPng(size, size, 1, false, [size](glm::vec2 uv) {
    float line = cellNoise(0, static_cast<int>(uv.y * static_cast<float>(size)), 51);
    return glm::vec3(1.0f, 0.3f + 0.14f * line, 1.0f);
  });
}

Png chequerBaseColor(int size, int columns, int rows, glm::vec3 light, glm::vec3 dark) {
  return paintedPng(size, size, 1, true, [=](glm::vec2 uv) {
    glm::ivec2 cell(glm::floor(uv * glm::vec2(columns, rows)));
    return (cell.x + cell.y) % 2 == 0 ? light : dark;
  });
}

} // namespace brickfield::scenes
