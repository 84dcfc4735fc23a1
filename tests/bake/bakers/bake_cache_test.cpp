// The cache: hits, damage, cancelled bakes, what the hash hangs on, many at once.
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "core/error.h"
#include "field/bricks_file.h"
#include "tests/bake/bakers/mesh_cases.h"
#include "tests/support/temporary_folder.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

MeshCase ball() {
  MeshCase result;
  result.addSphere({0, 0, 0}, 1, 16, 32);
  for (const glm::vec3 p : result.primitive().positions) result.primitive().uvs[0].push_back({p.x, p.y});
  result.scene.images.push_back({"paint", {1, 1}, {10, 20, 30, 255}});
  result.scene.textures.emplace_back().image = 0;
  result.material().baseColorTexture.texture = 0;
  return result;
}

BakeSettings smallSettings() {
  BakeSettings settings;
  settings.resolution = 24;
  return settings;
}

std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

} // namespace

TEST(BakeCache, SecondBakeIsReadAndTheSame) {
  const TemporaryFolder folder;
  const MeshCase mesh = ball();
  bool wasCached = true;
  const BakeResult first = bakeCached(mesh.input(), smallSettings(), folder.path() / "new" / "cache", {}, &wasCached);
  EXPECT_FALSE(wasCached);
  ASSERT_EQ(filesIn(folder.path()).size(), 1u);
  EXPECT_EQ(filesIn(folder.path())[0].filename(), bakeHash(mesh.input(), smallSettings()).text() + ".bricks");
  const BakeResult second = bakeCached(mesh.input(), smallSettings(), folder.path() / "new" / "cache", {}, &wasCached);
  EXPECT_TRUE(wasCached);
  EXPECT_TRUE(encodeBricks(first.field) == encodeBricks(second.field));
  EXPECT_EQ(second.stats.bricks, first.stats.bricks);
  EXPECT_EQ(first.cacheWarning + second.cacheWarning, "");
}

TEST(BakeCache, DamagedEntryIsBakedAnewAndReplaced) {
  const TemporaryFolder folder;
  const MeshCase mesh = ball();
  const std::vector<std::byte> expected = encodeBricks(bakeCached(mesh.input(), smallSettings(), folder.path()).field);
  const std::filesystem::path entry = filesIn(folder.path()).at(0);
  const auto size = std::filesystem::file_size(entry);
  const auto damage = [&](int kind) {
    if (kind == 0) std::filesystem::resize_file(entry, size / 2);
    if (kind == 1) std::ofstream(entry, std::ios::trunc) << "not bricks";
    if (kind == 2)
      std::fstream(entry, std::ios::in | std::ios::out).seekp(static_cast<std::streamoff>(size / 2)) << "XXXX";
    if (kind == 3) { // sound, but of something else
      BakeSettings other = smallSettings();
      other.resolution = 20;
      writeBricksFile(entry, bakeField(mesh.input(), other).field);
    }
  };
  for (int kind = 0; kind < 4; ++kind) {
    damage(kind);
    bool wasCached = true;
    const BakeResult again = bakeCached(mesh.input(), smallSettings(), folder.path(), {}, &wasCached);
    EXPECT_FALSE(wasCached) << kind;
    EXPECT_TRUE(again.cacheWarning.starts_with(entry.string() + ": ")) << again.cacheWarning;
    EXPECT_TRUE(again.cacheWarning.ends_with("; baked anew")) << again.cacheWarning;
    EXPECT_TRUE(encodeBricks(again.field) == expected) << kind;
    bakeCached(mesh.input(), smallSettings(), folder.path(), {}, &wasCached);
    EXPECT_TRUE(wasCached) << kind;
  }
}

TEST(BakeCache, CancelledBakeLeavesNothing) {
  const TemporaryFolder folder;
  const MeshCase mesh = ball();
  const std::atomic<bool> cancelled = true;
  Progress progress;
  progress.cancelled = &cancelled;
  EXPECT_THROW(bakeCached(mesh.input(), smallSettings(), folder.path(), progress), Cancelled);
  EXPECT_TRUE(filesIn(folder.path()).empty());
}

TEST(BakeCache, FolderThatCannotBeWrittenIsNoHindrance) {
  const TemporaryFolder folder;
  folder.write("file", "in the way");
  const MeshCase mesh = ball();
  bool wasCached = true;
  const BakeResult result = bakeCached(mesh.input(), smallSettings(), folder.path() / "file", {}, &wasCached);
  EXPECT_GT(result.stats.bricks, 0u);
  EXPECT_TRUE(result.cacheWarning.starts_with((folder.path() / "file").string() + ": ")) << result.cacheWarning;
  EXPECT_FALSE(wasCached);
}

TEST(BakeCache, SeveralAtOnceAgree) {
  const TemporaryFolder folder;
  const MeshCase mesh = ball();
  std::vector<std::vector<std::byte>> results(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < results.size(); ++i)
    threads.emplace_back([&, i] {
      for (int round = 0; round < 3; ++round)
        results[i] = encodeBricks(bakeCached(mesh.input(), smallSettings(), folder.path()).field);
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_TRUE(result == results[0]);
  EXPECT_EQ(filesIn(folder.path()).size(), 1u);
}

TEST(BakeCache, HashHangsOnAllThatDecidesTheBytes) {
  const Hash128 plain = bakeHash(ball().input(), smallSettings());
  EXPECT_EQ(plain, bakeHash(ball().input("another label"), smallSettings()));
  const auto expectOther = [&](const char* what, auto change) {
    MeshCase mesh = ball();
    BakeSettings settings = smallSettings();
    change(mesh, settings);
    EXPECT_NE(plain, bakeHash(mesh.input(), settings)) << what;
  };
  expectOther("position", [](MeshCase& m, BakeSettings&) { m.primitive().positions[5].x += 1e-3f; });
  expectOther("index",
              [](MeshCase& m, BakeSettings&) { std::swap(m.primitive().indices[0], m.primitive().indices[1]); });
  expectOther("uv", [](MeshCase& m, BakeSettings&) { m.primitive().uvs[0][2].x += 0.1f; });
  expectOther("factor", [](MeshCase& m, BakeSettings&) { m.material().baseColor.y = 0.5f; });
  expectOther("alpha mode", [](MeshCase& m, BakeSettings&) { m.material().alphaMode = AlphaMode::Mask; });
  expectOther("sides", [](MeshCase& m, BakeSettings&) { m.material().doubleSided = true; });
  expectOther("texel", [](MeshCase& m, BakeSettings&) { m.scene.images[0].rgba[1] = 99; });
  expectOther("wrap", [](MeshCase& m, BakeSettings&) { m.scene.textures[0].wrapU = Wrap::ClampToEdge; });
  expectOther("resolution", [](MeshCase&, BakeSettings& s) { s.resolution = 25; });
  expectOther("bits", [](MeshCase&, BakeSettings& s) { s.bits = 16; });
  expectOther("mips", [](MeshCase&, BakeSettings& s) { s.mips = 2; });
  expectOther("sign", [](MeshCase&, BakeSettings& s) { s.sign = SignMethod::TwoSided; });
  expectOther("thickness", [](MeshCase&, BakeSettings& s) { s.thickness = 0.1f; });
  expectOther("attributes", [](MeshCase&, BakeSettings& s) { s.attributes = false; });
  BakeSettings bare = smallSettings();
  bare.attributes = false;
  MeshCase masked = ball();
  masked.material().alphaMode = AlphaMode::Mask;
  const Hash128 before = bakeHash(masked.input(), bare);
  masked.scene.images[0].rgba[3] = 7;
  EXPECT_NE(before, bakeHash(masked.input(), bare)) << "masks cut the geometry, with attributes or without";
  BakeSettings threads = smallSettings();
  threads.threads = 7;
  EXPECT_EQ(plain, bakeHash(ball().input(), threads)) << "threads do not change the bytes";
}
