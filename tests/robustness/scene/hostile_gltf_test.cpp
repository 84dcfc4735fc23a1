// The folder of hostile files: each ends in time and memory, in a load or in one line that names it, and as expected.
// What the Khronos validator says of a file is the expectation, but for the tables below, which say why we differ.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/robustness/scene/import_outcome.h"
#include "tests/support/data.h"

namespace brickfield::test {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMemoryAllowed = std::uint64_t{1} << 30;

constexpr const char* kEmptyArray = "an empty array says the same as an absent one";
constexpr const char* kNoBounds = "min and max are not needed: bounds come from the data";
constexpr const char* kUnusedImage = "no material uses the image, so that nobody opens it";
constexpr const char* kUnusedData = "nothing that is read refers to the accessor";
constexpr const char* kOtherAttribute = "attributes that are not read are left out with a warning";

// Loaded although the validator finds errors.
const std::map<std::string, const char*> kLoadedInSpite = {
    {"accessor/empty_array.gltf", kEmptyArray},
    {"animation/empty_array.gltf", kEmptyArray},
    {"buffer/empty_array.gltf", kEmptyArray},
    {"buffer_view/empty_array.gltf", kEmptyArray},
    {"camera/empty_array.gltf", kEmptyArray},
    {"image/empty_array.gltf", kEmptyArray},
    {"material/empty_array.gltf", kEmptyArray},
    {"mesh/empty_array.gltf", kEmptyArray},
    {"node/empty_array.gltf", kEmptyArray},
    {"node/empty_children_array.gltf", kEmptyArray},
    {"sampler/empty_array.gltf", kEmptyArray},
    {"scene/empty_array.gltf", kEmptyArray},
    {"scene/empty_nodes_array.gltf", kEmptyArray},
    {"skin/empty_array.gltf", kEmptyArray},
    {"texture/empty_array.gltf", kEmptyArray},
    {"accessor_data/invalid_elements_float.gltf", kUnusedData},
    {"accessor_data/out_of_range_elements_float.gltf", kNoBounds},
    {"accessor_data/out_of_range_elements_sint16.gltf", kNoBounds},
    {"accessor_data/out_of_range_elements_sint8.gltf", kNoBounds},
    {"accessor_data/out_of_range_elements_uint16.gltf", kNoBounds},
    {"accessor_data/out_of_range_elements_uint32.gltf", kNoBounds},
    {"accessor_data/out_of_range_elements_uint8.gltf", kNoBounds},
    {"animation/sampler_input_no_bounds.gltf", kNoBounds},
    {"mesh/morph_position_accessor_no_bounds.gltf", kNoBounds},
    {"mesh/position_accessor_no_bounds.gltf", kNoBounds},
    {"animation_data/quaternion_cubic_non_unit_values.gltf", "the times have no data: the channel is left out"},
    {"animation_data/quaternion_non_unit_values.gltf", "the times have no data: the channel is left out"},
    {"image/invalid_data_uri.gltf", kUnusedImage},
    {"image/invalid_data_uri_mime_type.gltf", kUnusedImage},
    {"image/invalid_image_data.gltf", kUnusedImage},
    {"image/invalid_uri_scheme.gltf", kUnusedImage},
    {"image/not_found.gltf", kUnusedImage},
    {"image/png_eos.gltf", kUnusedImage},
    {"mesh/accessor_attribute_uint32.gltf", kOtherAttribute},
    {"mesh/invalid_attribute.gltf", kOtherAttribute},
    {"mesh/invalid_attribute_escaped_name.gltf", kOtherAttribute},
    {"mesh/invalid_indexed_attribute.gltf", kOtherAttribute},
    {"mesh/uv.gltf", "a texture without uvs shows its corner, with a warning"},
    {"mesh_data/colors_non_clamped.gltf", "colours are clamped, with a warning"},
    {"mesh_data/joints_weights_complex.gltf", "points are left out, their weights with them"},
    {"node/rotation_non_unit.gltf", "rotations are made unit, with a warning"},
    {"root/duplicate_extension_entry.gltf", "an extension named twice is named"},
    {"root/extensions_undeclared_wrong_pointer.gltf", "what extensionsUsed forgets is harmless"},
    {"skin/no_joints_in_scene.gltf", "joints that no scene shows still have their place"},
    {"skin/skeleton_invalid.gltf", "the skeleton's root is a hint that nobody needs"},
};

// Refused although the validator finds no error.
const std::map<std::string, const char*> kRefusedInSpite = {
    {"accessor/unknown_type.gltf", "a type that we do not know cannot be measured"},
    {"asset/min_version_valid.gltf", "it asks for glTF 2.1, we read 2.0"},
    {"buffer/data_uri.glb", "data uris must be base64"},
    {"buffer/non_relative_uri.gltf", "nothing is fetched from a network"},
    {"camera/perspective_yfov.gltf", "a field of view above half a turn is no perspective"},
    {"root/named_objects.gltf", "its skin needs a buffer that the file does not have"},
    {"root/unused_objects.gltf", "its skin needs a buffer that the file does not have"},
};

// Files without a report of the validator that have to load; all others have to be refused.
const std::map<std::string, const char*> kLoadedUnreported = {
    {"asset_generator_negative/Mesh_NoPosition/Mesh_NoPosition_00.gltf", "a primitive without positions is left out"},
    {"asset_generator_negative/Mesh_NoPosition/Mesh_NoPosition_01.gltf", "a primitive without positions is left out"},
    {"assimp/boxbadnormals-gltf-binary/BoxBadNormals.glb", "normals are repaired, with a warning"},
    {"assimp/issue_3269/texcoord_crash.gltf", "a texture without uvs shows its corner, with a warning"},
    {"assimp/testnorootnode/SceneWithoutNodes.gltf", "an empty scene is valid"},
    {"cgltf_fuzz/Box.glb", "a valid file"},
    {"cgltf_fuzz/TriangleWithoutIndices.gltf", "a valid file"},
    {"sharpgltf/Invalid_EmptyArray.gltf", kEmptyArray},
    {"tinygltf/regression/issue-492.glb", "nothing in it is drawn"},
    {"tinygltf/regression/zero-sized-bin-chunk-issue-440.glb", "a BIN chunk may be empty"},
};

std::vector<std::string> hostileFiles() {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(dataFile("hostile")))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      files.push_back(fs::relative(entry.path(), dataFile("hostile")).string());
  std::sort(files.begin(), files.end());
  return files;
}

// The number of errors that the validator found, where it was asked.
std::optional<int> reportedErrors(const std::string& file) {
  std::ifstream stream(dataFile("hostile/" + file + ".report.json"));
  if (!stream) return std::nullopt;
  return nlohmann::json::parse(stream)["issues"]["numErrors"].get<int>();
}

Ending expectedEnding(const std::string& file) {
  const std::optional<int> errors = reportedErrors(file);
  if (!errors) return kLoadedUnreported.contains(file) ? Ending::Loaded : Ending::Refused;
  const std::string inFolder = file.substr(file.find('/') + 1);
  if (kLoadedInSpite.contains(inFolder)) return Ending::Loaded;
  if (kRefusedInSpite.contains(inFolder)) return Ending::Refused;
  return *errors == 0 ? Ending::Loaded : Ending::Refused;
}

TEST(HostileGltf, EveryFileEndsAsExpectedInTimeAndMemory) {
  if (!requireData("hostile/README.md")) return;
  const std::vector<std::string> files = hostileFiles();
  EXPECT_GE(files.size(), 300u);
  int loaded = 0;
  std::uint64_t peakBytes = 0;
  double slowest = 0.0;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const fs::path path = dataFile("hostile/" + file);
    const ImportOutcome outcome = importApart(path);
    EXPECT_STREQ(name(outcome.ending), name(expectedEnding(file))) << outcome.message;
    EXPECT_LT(outcome.peakBytes, kMemoryAllowed);
    peakBytes = std::max(peakBytes, outcome.peakBytes);
    slowest = std::max(slowest, outcome.seconds);
    loaded += outcome.ending == Ending::Loaded;
    if (outcome.ending != Ending::Refused) continue;
    EXPECT_THAT(outcome.message, ::testing::StartsWith(path.string() + ": "));
    EXPECT_THAT(outcome.message, ::testing::Not(::testing::HasSubstr("json.exception")));
    EXPECT_EQ(outcome.message.find('\n'), std::string::npos);
    EXPECT_GT(outcome.message.size(), path.string().size() + 10) << "the element and the reason are named";
  }
  std::printf("%zu files, %d loaded, slowest %.3f s, largest %.0f MiB\n", files.size(), loaded, slowest,
              static_cast<double>(peakBytes) / (1 << 20));
}

TEST(HostileGltf, TablesNameFilesThatExistAndDiffer) {
  if (!requireData("hostile/README.md")) return;
  for (const auto& [file, reason] : kLoadedInSpite)
    EXPECT_GT(reportedErrors("validator/" + file).value_or(0), 0) << file;
  for (const auto& [file, reason] : kRefusedInSpite)
    EXPECT_EQ(reportedErrors("validator/" + file).value_or(-1), 0) << file;
  for (const auto& [file, reason] : kLoadedUnreported) EXPECT_TRUE(fs::exists(dataFile("hostile/" + file))) << file;
}

TEST(HostileGltf, ControlsOfTheValidatorLoad) {
  if (!requireData("hostile/README.md")) return;
  int controls = 0;
  for (const std::string& file : hostileFiles()) {
    if (!fs::path(file).filename().string().starts_with("valid")) continue;
    ++controls;
    const ImportOutcome outcome = importApart(dataFile("hostile/" + file));
    EXPECT_STREQ(name(outcome.ending), "loaded") << file << ": " << outcome.message;
  }
  EXPECT_GE(controls, 15);
}

} // namespace

} // namespace brickfield::test
