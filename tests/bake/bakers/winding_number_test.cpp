// The fast winding number against closed forms and against all solid angles in double.
#include "bakers/winding_number.h"

#include <gtest/gtest.h>

#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

float windingAt(const TriangleSoup& soup, glm::dvec3 point) {
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  return WindingNumber(hierarchy).at(point);
}

double largestError(const TriangleSoup& soup, const std::vector<glm::dvec3>& points) {
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const WindingNumber winding(hierarchy);
  double largest = 0;
  for (const glm::dvec3 point : points)
    largest = std::max(largest, std::abs(static_cast<double>(winding.at(point)) - bruteWinding(soup, point)));
  return largest;
}

} // namespace

TEST(WindingNumber, SphereIsOneInsideAndZeroOutside) {
  MeshCase sphere;
  sphere.addSphere({5, 0, 0}, 2, 48, 96);
  const TriangleSoup soup = sphere.soup();
  const double radius = 2 * soup.unitsPerMetre;
  EXPECT_NEAR(windingAt(soup, {0, 0, 0}), 1, 2e-3);
  EXPECT_NEAR(windingAt(soup, {0, 0.98 * radius, 0}), 1, 1e-2);
  EXPECT_NEAR(windingAt(soup, {0, 1.02 * radius, 0}), 0, 1e-2);
  EXPECT_NEAR(windingAt(soup, {3, 4, 5}), 0, 1e-3);
}

TEST(WindingNumber, InvertedBoxIsMinusOneInside) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1), true);
  EXPECT_NEAR(windingAt(box.soup(), glm::dvec3(0.1, 0.2, 0)), -1, 1e-5);
}

TEST(WindingNumber, SquareOfABoxIsASixthFromItsMiddle) {
  MeshCase square; // from the middle of a box each face covers a sixth of the sphere, and is seen from behind
  square.addQuad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1});
  const TriangleSoup soup = square.soup();
  EXPECT_NEAR(windingAt(soup, soup.soupFromObject({0, 0, 0})), 1.0 / 6, 1e-6);
  EXPECT_NEAR(windingAt(soup, soup.soupFromObject({0, 0, 2})), -1.0 / 6, 1e-6);
}

TEST(WindingNumber, OpenHemisphereLacksTheSolidAngleOfItsOpening) {
  MeshCase bowl; // the lower half of a unit sphere; the opening seen from depth z is a disk
  bowl.addSphere({0, 0, 0}, 1, 180, 360, 90);
  const TriangleSoup soup = bowl.soup();
  for (const double depth : {0.05, 0.3, 0.6, 0.9}) {
    const double opening = 2 * std::numbers::pi * (1 - depth / std::sqrt(depth * depth + 1));
    const double expected = 1 - opening / (4 * std::numbers::pi);
    EXPECT_NEAR(windingAt(soup, soup.soupFromObject({0, -depth, 0})), expected, 5e-3) << depth;
    EXPECT_NEAR(windingAt(soup, soup.soupFromObject({0, depth, 0})), 1 - expected, 5e-3) << depth;
  }
}

TEST(WindingNumber, RealMeshesAgreeWithAllSolidAngles) {
  for (const char* name : {"stanford_dragon_11k.glb", "torus_5k.glb", "utah_teapot_6k.glb", "avocado.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const FileCase file(name);
    const TriangleSoup soup = gatherTriangles(file.input());
    EXPECT_LT(largestError(soup, randomPoints(300, 1, 11)), 0.01) << name;
    EXPECT_LT(largestError(soup, pointsNearSurface(soup, 300, 0.01, 12)), 0.01) << name;
  }
}
