// Wrong JSON types, ranges and references, containers and versions: each with the element named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scene/gltf_builder.h"

namespace brickfield::test {

namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string errorOfMembers(const std::string& members) {
  return errorOfText(R"({"asset":{"version":"2.0"},)" + members + "}");
}

TEST(GltfSchema, WrongTypesAreNotDefaults) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("nodes":[{"mesh":"0"}])", "test.gltf: node 0: mesh: is a JSON string, not an integer"},
      {R"("meshes":{})", "meshes: is a JSON object, not an array"},
      {R"("nodes":[3])", "node 0: is a JSON number, not an object"},
      {R"("nodes":[{"name":7}])", "node 0: name: is not a string"},
      {R"("nodes":[{"name":"A","children":[0.5]}])", "node 0 \"A\": children[0]: 0.5 is not an integer"},
      {R"("nodes":[{"children":{}}])", "children: is a JSON object"},
      {R"("nodes":[{"scale":[1,"2",3]}])", "scale[1]: is a JSON string, not a number"},
      {R"("scene":true)", "glTF: scene: is a JSON boolean"},
      {R"("materials":[{"doubleSided":1}])", "material 0: doubleSided: is neither true nor false"},
      {R"("materials":[{"alphaMode":"Blend"}])", "\"Blend\" is none of OPAQUE|MASK|BLEND"},
      {R"("materials":[{"emissiveFactor":[1,1,2]}])", "emissiveFactor[2]: 2 is out of range"},
      {R"("materials":[{"extensions":{"KHR_materials_unlit":3}}])", "extensions.KHR_materials_unlit: is a JSON number"},
      {R"("accessors":[{"componentType":5124,"count":1,"type":"SCALAR"}])",
       "accessor 0: componentType: 5124 is none of"},
      {R"("accessors":[{"componentType":5126,"count":0,"type":"SCALAR"}])", "count: 0 is out of range"},
      {R"("accessors":[{"componentType":5126,"count":-1,"type":"SCALAR"}])", "count: -1 is out of range"},
      {R"("accessors":[{"componentType":5126,"count":1}])", "accessor 0: type: is missing"},
      {R"("extensionsUsed":[1])", "extensionsUsed[0]: is a JSON number, not a string"},
      {R"("meshes":[{"primitives":[{"attributes":{},"mode":7}]}])", "mesh 0: primitives[0].mode: 7 is out of range"},
  };
  for (const auto& [members, message] : cases) EXPECT_THAT(errorOfMembers(members), HasSubstr(message)) << members;
}

TEST(GltfSchema, ReferencesMustExist) {
  const std::string accessor = R"("accessors":[{"componentType":5126,"count":1,"type":"VEC3"}],)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("nodes":[{"mesh":0}])", "mesh: 0 does not exist, the file has 0 meshes"},
      {R"("nodes":[{"mesh":-1}])", "mesh: -1 does not exist"},
      {R"("nodes":[{"mesh":1e300}])", "is not an integer"},
      {R"("nodes":[{"mesh":18446744073709551615}])", "is not an integer"},
      {R"("nodes":[{"camera":0}])", "0 cameras"},
      {R"("nodes":[{"skin":0}])", "0 skins"},
      {R"("nodes":[{"children":[1]}])", "1 nodes"},
      {R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}}])", "0 lights"},
      {R"("scenes":[{"nodes":[0]}])", "0 nodes"},
      {R"("skins":[{"joints":[0]}])", "0 nodes"},
      {R"("nodes":[{}],"skins":[{"joints":[0],"skeleton":1}])", "1 nodes"},
      {R"("nodes":[{}],"skins":[{"joints":[0],"inverseBindMatrices":0}])", "0 accessors"},
      {R"("bufferViews":[{"buffer":0,"byteLength":1}])", "0 buffers"},
      {R"("accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}])", "0 bufferViews"},
      {R"("textures":[{"source":0}])", "0 images"},
      {R"("textures":[{"sampler":0}])", "0 samplers"},
      {R"("images":[{"bufferView":0,"mimeType":"image/png"}])", "0 bufferViews"},
      {R"("materials":[{"normalTexture":{"index":0}}])", "0 textures"},
      {R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])",
       "primitives[0].attributes.POSITION: 0 does not exist, the file has 0 accessors"},
      {accessor + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])",
       "primitives[0].indices: 1 does not exist"},
      {accessor + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}])", "0 materials"},
      {accessor + R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}]}])",
       "targets[0].POSITION: 1 does not exist"},
      {R"("animations":[{"samplers":[{"input":0,"output":0}],"channels":[]}])", "samplers[0].input: 0 does not exist"},
  };
  for (const auto& [members, message] : cases) EXPECT_THAT(errorOfMembers(members), HasSubstr(message)) << members;
}

TEST(GltfSchema, IntegersMayBeWrittenAsFloats) {
  EXPECT_EQ(errorOfMembers(R"("nodes":[{"children":[1.0]},{}],"scenes":[{"nodes":[0.0]}],"scene":0e0)"), "");
}

TEST(GltfSchema, Versions) {
  const auto errorOf = [](const std::string& asset) { return errorOfText("{\"asset\":" + asset + "}"); };
  EXPECT_EQ(errorOf(R"({"version":"2.0"})"), "");
  EXPECT_EQ(errorOf(R"({"version":"2.7"})"), "") << "minor versions add only what may be ignored";
  EXPECT_EQ(errorOf(R"({"version":"2.1","minVersion":"2.0"})"), "");
  EXPECT_THAT(errorOf(R"({"version":"2.1","minVersion":"2.1"})"), HasSubstr("asset: asks for glTF 2.1"));
  EXPECT_THAT(errorOf(R"({"version":"1.0"})"), HasSubstr("glTF version 1.0"));
  EXPECT_THAT(errorOf(R"({"version":"3.0"})"), HasSubstr("glTF version 3.0"));
  EXPECT_THAT(errorOf(R"({"version":"2"})"), HasSubstr("not of the form"));
  EXPECT_THAT(errorOf(R"({"version":"2.0x"})"), HasSubstr("not of the form"));
  EXPECT_THAT(errorOf(R"({"version":2.0})"), HasSubstr("is a JSON number"));
  EXPECT_THAT(errorOf("{}"), HasSubstr("asset.version: is missing"));
  EXPECT_THAT(errorOfText("{}"), HasSubstr("asset: is missing"));
}

TEST(GltfSchema, BuffersAndViewsKeepTheirBounds) {
  const std::string buffer = R"("buffers":[{"byteLength":4,"uri":"data:application/octet-stream;base64,AAAAAA=="}],)";
  EXPECT_EQ(errorOfMembers(buffer + R"("bufferViews":[{"buffer":0,"byteLength":4}])"), "");
  EXPECT_THAT(errorOfMembers(buffer + R"("bufferViews":[{"buffer":0,"byteLength":5}])"),
              HasSubstr("bufferView 0: bytes 0 to 5 lie outside of buffer 0"));
  EXPECT_THAT(errorOfMembers(buffer + R"("bufferViews":[{"buffer":0,"byteOffset":1,"byteLength":4}])"),
              HasSubstr("lie outside"));
  EXPECT_THAT(
      errorOfMembers(buffer +
                     R"("bufferViews":[{"buffer":0,"byteOffset":9007199254740992,"byteLength":9007199254740992}])"),
      HasSubstr("lie outside"));
  EXPECT_THAT(
      errorOfMembers(
          buffer +
          R"("bufferViews":[{"buffer":0,"byteLength":4}],"accessors":[{"bufferView":0,"byteOffset":9007199254740992,"componentType":5121,"count":4294967295,"type":"SCALAR"}])"),
      HasSubstr("accessor 0: needs "));
  EXPECT_THAT(
      errorOfMembers(
          buffer +
          R"("bufferViews":[{"buffer":0,"byteLength":4}],"accessors":[{"bufferView":0,"byteOffset":2,"componentType":5126,"count":1,"type":"SCALAR"}])"),
      HasSubstr("multiple of its component's 4 bytes"));
  EXPECT_THAT(errorOfMembers(R"("buffers":[{"byteLength":5,"uri":"data:application/octet-stream;base64,AAAAAA=="}])"),
              HasSubstr("buffer 0: has 4 bytes, byteLength says 5"));
}

TEST(GltfContainer, LengthsAndChunksAreChecked) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.accessor("VEC3", squarePositions())}});
  const std::vector<std::byte> good = builder.glb();
  const auto errorOf = [&](std::size_t offset, std::uint32_t value) {
    std::vector<std::byte> bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[offset + i] = static_cast<std::byte>(value >> (8 * i) & 0xFF);
    try {
      importGltfBytes(bytes, "test.glb", {});
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto size = static_cast<std::uint32_t>(good.size());
  EXPECT_EQ(errorOf(8, size), "");
  EXPECT_THAT(errorOf(0, 0), HasSubstr("test.glb: GLB: does not start with"));
  EXPECT_THAT(errorOf(4, 1), HasSubstr("container version 1"));
  EXPECT_THAT(errorOf(8, size + 4), HasSubstr("header says"));
  EXPECT_THAT(errorOf(8, 12), HasSubstr("too few"));
  EXPECT_THAT(errorOf(12, 0xFFFFFFFC), HasSubstr("chunk 0 says"));
  EXPECT_THAT(errorOf(12, 3), HasSubstr("not a multiple of 4"));
  EXPECT_THAT(errorOf(16, 0x004E4942), HasSubstr("the first chunk is not JSON"));
}

} // namespace

} // namespace brickfield::test
