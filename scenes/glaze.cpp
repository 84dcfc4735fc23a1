// The teapot's glaze: cobalt ornament and gold lines on white, drawn in the texture's own layout. Lengths on the pot
// are in the teapot's units: the body's widest circle is 4π long.
#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "scenes/teapot_patches.h"
#include "scenes/textures.h"

namespace brickfield::scenes {
namespace {

enum class Glaze { White, Cobalt, Gold };

constexpr float kGirth = 4 * glm::pi<float>();

/// Overlapping waves (Japanese seigaiha): each fan hides those of the row above it.
Glaze waveGlaze(glm::vec2 p, float radius) {
  // The lower row lies on top: look at the rows from the lowest that reaches here.
  for (int k = 2; k >= -1; --k) {
    auto row = static_cast<int>(std::floor(p.y / (0.5f * radius))) + k;
    float centerY = static_cast<float>(row) * 0.5f * radius;
    float shift = row % 2 == 0 ? 0.0f : radius;
    float x = p.x - shift;
    x -= 2 * radius * std::round(x / (2 * radius));
    float share = glm::length(glm::vec2(x, p.y - centerY)) / radius;
    if (share > 1 || p.y > centerY) continue;
    if (share > 0.93f) return Glaze::White;
    return std::fmod(share * 3.2f + 0.25f, 1.0f) < 0.62f ? Glaze::Cobalt : Glaze::White;
  }
  return Glaze::White;
}

/// A flower of eight petals with a ring and a gold heart.
Glaze flowerGlaze(glm::vec2 p, float radius) {
  float distance = glm::length(p) / radius;
  float angle = std::atan2(p.y, p.x);
  if (distance < 0.17f) return Glaze::Gold;
  if (distance < 0.24f) return Glaze::White;
  float petal = 0.62f + 0.38f * std::pow(std::abs(std::cos(4 * angle)), 0.7f);
  if (distance < petal) {
    bool isVein = std::abs(std::sin(4 * angle)) < 0.16f && distance > 0.35f && distance < 0.8f;
    return isVein ? Glaze::White : Glaze::Cobalt;
  }
  return Glaze::White;
}

/// Two leaves and a bud between the flowers.
Glaze sprigGlaze(glm::vec2 p) {
  for (float side : {-1.0f, 1.0f}) {
    glm::vec2 q = p - glm::vec2(0.0f, 0.20f * side);
    float lens = std::abs(q.x) - 0.085f * (1.0f - (q.y / 0.17f) * (q.y / 0.17f));
    if (lens < 0 && std::abs(q.y) < 0.17f) return std::abs(q.x) < 0.012f ? Glaze::White : Glaze::Cobalt;
  }
  return glm::length(p) < 0.05f ? Glaze::Gold : Glaze::White;
}

Glaze bodyUpperGlaze(float around, float down) {
  if (down < 0.07f) return Glaze::Gold;
  if (down < 0.12f) return Glaze::White;
  if (down < 0.19f) return Glaze::Cobalt;
  if (down > 1.47f && down < 1.52f) return Glaze::Gold;
  if (down > 1.52f) return waveGlaze({around, down}, kGirth / 40);
  if (down > 1.40f && down < 1.44f) return Glaze::Cobalt;
  constexpr int kFlowers = 10;
  float spacing = kGirth / kFlowers;
  float inCell = around - spacing * std::round(around / spacing);
  glm::vec2 fromFlower(inCell, down - 0.80f);
  Glaze flower = flowerGlaze(fromFlower, 0.46f);
  if (flower != Glaze::White) return flower;
  float besides = std::abs(inCell) - 0.5f * spacing;
  return sprigGlaze({besides, down - 0.80f});
}

Glaze lidGlaze(float quarterTurns, float along) {
  // Scallops at the edge, a ring near the knob.
  if (along > 0.93f) return Glaze::Gold;
  if (along < 0.12f) return Glaze::Gold;
  if (along > 0.2f && along < 0.25f) return Glaze::Cobalt;
  float scallop = std::abs(std::sin(glm::pi<float>() * 5 * quarterTurns));
  float edge = 0.83f - 0.30f * std::sqrt(scallop);
  if (along > edge + 0.05f && along < 0.86f) return Glaze::Cobalt;
  if (along > edge - 0.035f && along < edge) return Glaze::Cobalt;
  return Glaze::White;
}

Glaze spoutGlaze(float around, float along) {
  if (along > 0.94f) return Glaze::Cobalt; // inside the lip
  if (along > 0.70f) return Glaze::Gold;
  if (along > 0.62f && along < 0.66f) return Glaze::Cobalt;
  float half = std::abs(2 * around - std::floor(2 * around) - 0.5f) * 2; // 0 on the flanks
  bool isTendril = std::abs(half - 0.5f - 0.28f * std::sin(glm::two_pi<float>() * 2.5f * along)) < 0.055f;
  return isTendril && along < 0.60f ? Glaze::Cobalt : Glaze::White;
}

Glaze handleGlaze(float around, float along) {
  float half = std::abs(2 * around - std::floor(2 * around) - 0.5f) * 2;
  bool isOuter = around > 0.25f && around < 0.75f;
  if (isOuter && half > 0.62f) return std::fmod(along * 14, 1.0f) < 0.18f ? Glaze::Gold : Glaze::Cobalt;
  return Glaze::White;
}

TeapotPart partAt(float v) {
  for (TeapotPart part : {TeapotPart::LidKnob, TeapotPart::Lid, TeapotPart::Rim, TeapotPart::BodyUpper,
                          TeapotPart::BodyLower, TeapotPart::Bottom, TeapotPart::Spout}) {
    if (v < teapotTextureRows(part).y) return part;
  }
  return TeapotPart::Handle;
}

Glaze glazeAt(glm::vec2 uv) {
  TeapotPart part = partAt(uv.y);
  glm::vec2 rows = teapotTextureRows(part);
  float along = (uv.y - rows.x) / (rows.y - rows.x);
  switch (part) {
  case TeapotPart::LidKnob:
    return Glaze::Gold;
  case TeapotPart::Lid:
    return lidGlaze(4 * uv.x, along);
  case TeapotPart::Rim:
    return Glaze::Gold;
  case TeapotPart::BodyUpper:
    return bodyUpperGlaze(kGirth * uv.x, 1.62f * along);
  case TeapotPart::BodyLower:
    return along > 0.86f ? Glaze::Gold : waveGlaze({kGirth * uv.x, 1.62f + 1.0f * along}, kGirth / 40);
  case TeapotPart::Bottom:
    return Glaze::White;
  case TeapotPart::Spout:
    return spoutGlaze(uv.x, along);
  case TeapotPart::Handle:
    return handleGlaze(uv.x, along);
  }
  return Glaze::White;
}

} // namespace

Png glazeBaseColor(int size) {
  return paintedPng(size, size, 3, true, [](glm::vec2 uv) {
    switch (glazeAt(uv)) {
    case Glaze::White:
      return glm::vec3(0.84f, 0.82f, 0.77f);
    case Glaze::Cobalt:
      return glm::vec3(0.012f, 0.045f, 0.26f);
    case Glaze::Gold:
      return glm::vec3(0.95f, 0.62f, 0.22f);
    }
    return glm::vec3(0);
  });
}

Png glazeMetallicRoughness(int size) {
  return paintedPng(size, size, 2, false, [](glm::vec2 uv) {
    bool isGold = glazeAt(uv) == Glaze::Gold;
    return glm::vec3(1.0f, isGold ? 0.34f : 0.16f, isGold ? 1.0f : 0.0f);
  });
}

} // namespace brickfield::scenes
