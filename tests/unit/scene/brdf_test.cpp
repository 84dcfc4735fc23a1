// The BRDF's laws: normalisation, reciprocity, energy; and the environment table against its integral.
#include "scene/brdf.h"

#include <numbers>

#include <gtest/gtest.h>

using namespace brickfield;

namespace {

constexpr double kPi = std::numbers::pi;
const glm::vec3 kNormal(0, 0, 1);

glm::vec3 directionOf(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return glm::vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
}

/// Share of a white environment's light that is sent to the viewer. The lobe is followed by drawing half vectors from
/// GGX on a grid (Walter et al. 2007), the diffuse part by drawing cosine-weighted ones.
double directionalAlbedo(const SurfaceBrdf& brdf, double nDotV, bool specularOnly) {
  constexpr int kGrid = 400;
  const glm::vec3 viewer = directionOf(nDotV, 0.0);
  SurfaceBrdf specular = brdf;
  specular.diffuse = glm::vec3(0.0f);
  double sum = 0.0;
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const double u = (i + 0.5) / kGrid, azimuth = 2.0 * kPi * (j + 0.5) / kGrid;
      const double alphaSquared = double{brdf.alpha} * brdf.alpha;
      const glm::vec3 halfway = directionOf(std::sqrt((1.0 - u) / (1.0 + (alphaSquared - 1.0) * u)), azimuth);
      const glm::vec3 light = glm::reflect(-viewer, halfway);
      const float vDotH = glm::dot(viewer, halfway);
      if (light.z > 0.0f && vDotH > 0.0f) {
        const double density = double{distributionGgx(brdf.alpha, halfway.z)} * halfway.z / (4.0 * vDotH);
        sum += evaluateBrdf(specular, kNormal, viewer, light).x * light.z / density;
      }
      if (specularOnly) continue;
      const glm::vec3 diffuseLight = directionOf(std::sqrt(1.0 - u), azimuth);
      const glm::vec3 diffuse =
          evaluateBrdf(brdf, kNormal, viewer, diffuseLight) - evaluateBrdf(specular, kNormal, viewer, diffuseLight);
      sum += diffuse.x * kPi;
    }
  return sum / (double{kGrid} * kGrid);
}

} // namespace

TEST(Brdf, DistributionIsNormalised) {
  // The projected area of all microfacets is that of the surface.
  for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f}) {
    double sum = 0.0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      sum += distributionGgx(alpha, static_cast<float>(cosine)) * cosine * 2.0 * kPi / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 2e-3) << alpha;
  }
  EXPECT_EQ(distributionGgx(0.5f, -0.1f), 0.0f);
}

TEST(Brdf, FresnelRunsFromF0ToWhite) {
  EXPECT_EQ(fresnelSchlick(glm::vec3(0.04f), 1.0f).x, 0.04f);
  EXPECT_EQ(fresnelSchlick(glm::vec3(0.04f), 0.0f).x, 1.0f);
  EXPECT_NEAR(fresnelSchlick(glm::vec3(0.04f), 0.5f).x, 0.04f + 0.96f / 32.0f, 1e-6f);
}

TEST(Brdf, MaterialsSplitIntoMetalAndDielectric) {
  const SurfaceBrdf metal = makeBrdf({0.9f, 0.6f, 0.3f}, 1.0f, 0.5f);
  EXPECT_EQ(metal.diffuse, glm::vec3(0.0f));
  EXPECT_EQ(metal.f0, glm::vec3(0.9f, 0.6f, 0.3f));
  EXPECT_EQ(metal.alpha, 0.25f);
  const SurfaceBrdf plastic = makeBrdf({0.9f, 0.6f, 0.3f}, 0.0f, 0.0f);
  EXPECT_EQ(plastic.diffuse, glm::vec3(0.9f, 0.6f, 0.3f));
  EXPECT_EQ(plastic.f0, glm::vec3(0.04f));
  EXPECT_EQ(plastic.alpha, kLeastRoughness * kLeastRoughness);
}

TEST(Brdf, SwappingLightAndViewerChangesNothing) {
  for (const float roughness : {0.05f, 0.3f, 0.7f, 1.0f})
    for (const float metallic : {0.0f, 0.5f, 1.0f}) {
      const SurfaceBrdf brdf = makeBrdf({0.8f, 0.5f, 0.2f}, metallic, roughness);
      for (int i = 0; i < 50; ++i) {
        const glm::vec3 a = directionOf(0.02 + 0.0195 * i, 0.7 * i), b = directionOf(0.99 - 0.019 * i, 1.9 * i);
        const glm::vec3 forth = evaluateBrdf(brdf, kNormal, a, b), back = evaluateBrdf(brdf, kNormal, b, a);
        EXPECT_NEAR(forth.x, back.x, 1e-5f * (1.0f + forth.x));
      }
    }
}

TEST(Brdf, LightFromBelowTheHorizonDoesNotCount) {
  const SurfaceBrdf brdf = makeBrdf(glm::vec3(1.0f), 0.0f, 0.5f);
  EXPECT_EQ(evaluateBrdf(brdf, kNormal, directionOf(0.5, 0), directionOf(-0.1, 1)), glm::vec3(0.0f));
  const glm::vec3 fromBelow = evaluateBrdf(brdf, kNormal, directionOf(-0.5, 0), directionOf(0.6, 1));
  EXPECT_TRUE(isFinite(fromBelow)) << "a viewer below it is a normal map's doing";
  EXPECT_GT(fromBelow.x, 0.0f);
}

TEST(Brdf, WhiteFurnaceGivesNoMoreThanItTakes) {
  for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
    for (const double nDotV : {0.1, 0.4, 0.7, 1.0}) {
      // 1e-3: error of the grid at grazing view.
      const double metal = directionalAlbedo(makeBrdf(glm::vec3(1.0f), 1.0f, roughness), nDotV, true);
      EXPECT_LE(metal, 1.0 + 1e-3) << roughness << " " << nDotV;
      const double gloss = directionalAlbedo(makeBrdf(glm::vec3(1.0f), 0.0f, roughness), nDotV, true);
      EXPECT_LE(gloss, metal) << roughness << " " << nDotV;
      if (roughness > 0.1f) continue;
      EXPECT_GE(metal, 0.97) << "a smooth white mirror loses nothing: " << nDotV;
    }
}

TEST(Brdf, WhiteDielectricExceedsItsFurnaceOnlyAtGrazingView) {
  // glTF weighs the diffuse part by 1 - F of each half vector, which takes too little at grazing view: a known
  // shortcoming of the format's formula, not of ours. Up to 60 degrees it keeps its energy to three percent.
  for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
    for (const double nDotV : {0.5, 0.7, 1.0}) {
      const double albedo = directionalAlbedo(makeBrdf(glm::vec3(1.0f), 0.0f, roughness), nDotV, false);
      EXPECT_LE(albedo, 1.03) << roughness << " " << nDotV;
      EXPECT_GE(albedo, 0.9) << roughness << " " << nDotV;
    }
}

// Seen straight on the half vector lies halfway to the light, so of the lobe alone
//   2 pi N \int_0^1 ((1 + c) / 2)^(s/2) c dc = f0
// in closed form; the sum over the hemisphere must say so, too.
TEST(Brdf, BlinnPhongSendsF0BackToWhoLooksStraightOn) {
  for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
    const SurfaceBrdf mirror = makeBrdf({0.9f, 0.5f, 0.2f}, 1.0f, roughness);
    const SurfaceBrdf plastic = makeBrdf({0.9f, 0.5f, 0.2f}, 0.0f, roughness);
    glm::dvec3 fromMirror(0), fromPlastic(0);
    constexpr int kSteps = 400000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      const glm::vec3 light = directionOf(cosine, 0.3);
      const double weight = 2 * kPi * light.z / kSteps;
      fromMirror += weight * glm::dvec3(evaluateBlinnPhong(mirror, kNormal, kNormal, light));
      fromPlastic += weight * glm::dvec3(evaluateBlinnPhong(plastic, kNormal, kNormal, light));
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(fromMirror[c], double{mirror.f0[c]}, 2e-3) << roughness;
      EXPECT_NEAR(fromPlastic[c], 0.04 + 0.96 * double{plastic.diffuse[c]}, 2e-3) << roughness;
    }
  }
}

TEST(Brdf, BlinnPhongIsSymmetricAndDarkBelowTheHorizon) {
  EXPECT_EQ(blinnPhongExponent(1.0f), 0.0f);
  EXPECT_NEAR(blinnPhongExponent(0.1f), 198.0f, 1e-3f);
  const SurfaceBrdf brdf = makeBrdf({0.8f, 0.5f, 0.2f}, 0.5f, 0.4f);
  for (int i = 0; i < 50; ++i) {
    const glm::vec3 a = directionOf(0.02 + 0.0195 * i, 0.7 * i), b = directionOf(0.99 - 0.019 * i, 1.9 * i);
    const glm::vec3 forth = evaluateBlinnPhong(brdf, kNormal, a, b), back = evaluateBlinnPhong(brdf, kNormal, b, a);
    EXPECT_NEAR(forth.x, back.x, 1e-5f * (1.0f + forth.x));
  }
  EXPECT_EQ(evaluateBlinnPhong(brdf, kNormal, directionOf(0.5, 0), directionOf(-0.1, 1)), glm::vec3(0.0f));
}

TEST(Brdf, EnvironmentTableIsItsIntegral) {
  double worst = 0.0;
  for (const float roughness : {0.1f, 0.3f, 0.5f, 0.7f, 1.0f})
    for (const double nDotV : {0.1, 0.3, 0.5, 0.8, 1.0}) {
      const double black = directionalAlbedo({glm::vec3(0.0f), glm::vec3(0.0f), roughness * roughness}, nDotV, true);
      const double white = directionalAlbedo({glm::vec3(0.0f), glm::vec3(1.0f), roughness * roughness}, nDotV, true);
      const glm::vec2 entry = environmentBrdf(roughness, static_cast<float>(nDotV));
      worst = std::max({worst, std::abs(entry.y - black), std::abs(entry.x + entry.y - white)});
    }
  // The table's coarser grid and its straight lines between entries; measured 0.0036.
  EXPECT_LE(worst, 0.005);
}
