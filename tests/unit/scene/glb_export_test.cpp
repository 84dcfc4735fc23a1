// What is written is what the importer reads.
#include "scene/glb_export.h"

#include <gtest/gtest.h>

#include "core/files.h"
#include "scene/gltf_import.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using namespace test;

Primitive twoTriangles() {
  Primitive primitive;
  primitive.positions = {{-1, 2, 0.1f}, {3, -0.5f, 7}, {0, 0, 0}, {1e-3f, 5e4f, -9}};
  primitive.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0.6f, -0.8f}};
  primitive.colors = {{0, 0.25f, 1, 1}, {0.5f, 0.125f, 0, 1}, {1, 1, 1, 1}, {0.001f, 0.7f, 0.3f, 1}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  return primitive;
}

Scene imported(const std::vector<std::byte>& bytes) {
  const TemporaryFolder folder;
  writeFile(folder / "made.glb", bytes);
  return importGltf(folder / "made.glb");
}

TEST(GlbExport, ComesBackWhole) {
  const Primitive written = twoTriangles();
  Material material;
  material.baseColor = {0.5f, 0.25f, 1, 1};
  material.metallic = 0.25f, material.roughness = 0.75f;
  const Scene scene = imported(encodeGlb("A \"name\"", written, material));
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
  ASSERT_EQ(scene.nodes.size(), 1u);
  EXPECT_EQ(scene.nodes[0].name, "A \"name\"");
  ASSERT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.meshes[0].primitives.size(), 1u);
  const Primitive& read = scene.meshes[0].primitives[0];
  EXPECT_EQ(read.positions, written.positions);
  EXPECT_EQ(read.normals, written.normals);
  EXPECT_EQ(read.indices, written.indices);
  ASSERT_EQ(read.colors.size(), written.colors.size());
  for (std::size_t i = 0; i < read.colors.size(); ++i)
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(read.colors[i][k], written.colors[i][k], 0.5f / 65535 + 1e-7f);
  const Material& surface = materialOf(scene, read);
  EXPECT_EQ(surface.baseColor, material.baseColor);
  EXPECT_EQ(surface.metallic, 0.25f);
  EXPECT_EQ(surface.roughness, 0.75f);
}

TEST(GlbExport, EmissionComesBackWeakOrStrong) {
  for (const glm::vec3 emission : {glm::vec3(0), glm::vec3(0.5f, 0.25f, 0), glm::vec3(1), glm::vec3(3, 12, 0.75f)}) {
    Material material;
    material.emission = emission;
    const std::vector<std::byte> bytes = encodeGlb("lamp", twoTriangles(), material);
    const Scene scene = imported(bytes);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    const glm::vec3 read = materialOf(scene, scene.meshes[0].primitives[0]).emission;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(read[k], emission[k], 1e-6f * emission[k]);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_EQ(text.find("emissive_strength") != text.npos, emission.y > 1) << "asked of readers only where needed";
  }
}

TEST(GlbExport, NeedsNoColours) {
  Primitive written = twoTriangles();
  written.colors.clear();
  const Scene scene = imported(encodeGlb("plain", written, {}));
  EXPECT_TRUE(scene.meshes[0].primitives[0].colors.empty());
}

TEST(GlbExport, NameNeedNotBeUtf8) {
  const Scene scene = imported(encodeGlb("caf\xe9", twoTriangles(), {}));
  EXPECT_EQ(scene.nodes[0].name, "caf\xef\xbf\xbd") << "replaced by U+FFFD";
}

} // namespace
} // namespace brickfield
