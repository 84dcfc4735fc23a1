// The program against wrong input of every kind: exit code 2, one line that names what is wrong, nothing written.
#include <cstring>
#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

using ::testing::HasSubstr;

TEST_F(CommandLine, HelpAndVersionAreDone) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"--version"}, {"render", "--help"}, {"bake", "-h"}, {"list", "--help"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.output, HasSubstr("brickfield"));
    EXPECT_EQ(result.messages, "");
  }
}

TEST_F(CommandLine, ProgramEndsWithTheExitCodeAndOneLine) {
  const ProgramResult result = run({"render", "absent.glb", "-o", "a.png"});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_EQ(result.messages, "brickfield: absent.glb: no such file\n");
  EXPECT_EQ(result.output, "");
}

TEST_F(CommandLine, RefusesUnknownCommandsAndFlags) {
  expectRefused({}, {"no command"});
  expectRefused({""}, {"brickfield: \"\": is no command; there are render"});
  expectRefused({" "}, {"brickfield: \" \": is no command"});
  expectRefused({"frobnicate"}, {"\"frobnicate\": is no command", "render", "bake"});
  expectRefused({"-x"}, {"brickfield: \"-x\": is not expected before a command"});
  expectRefused({"render", "scene.gltf", "--ou", "a.png"}, {"render: \"--ou\": is not expected here"});
  expectRefused({"list", "views", "more"}, {"list views: \"more\": is not expected here"});
  expectRefused({"--frob"}, {"--frob"});
  expectRefused({"render", "scene.gltf", "-o", "a.png", "--frob", "3"}, {"render", "--frob"});
  expectRefused({"render", "scene.gltf", "-o", "a.png", "more"}, {"render", "more"});
  expectRefused({"list"}, {"list", "views"});
  expectRefused({"list", "frobs"}, {"list", "frobs"});
}

TEST_F(CommandLine, RefusesMissingAndRepeatedArguments) {
  expectRefused({"render"}, {"render", "SCENE"});
  expectRefused({"render", "scene.gltf"}, {"render", "-o"});
  expectRefused({"render", "scene.gltf", "-o"}, {"-o"});
  expectRefused({"render", "scene.gltf", "-o", "a.png", "-o", "b.png"}, {"render", "output"});
  expectRefused({"bake", "scene.gltf"}, {"bake", "-o"});
  expectRefused({"compare", "text.png"}, {"compare", "B"});
  expectRefused({"list", "cameras"}, {"list cameras: SCENE is required"});
  for (const char* flag : {"--size", "--frames", "--eye", "--camera", "--sdf", "--light", "--layers", "--view"})
    expectRefused({"render", "scene.gltf", "-o", "a.png", flag}, {std::string(flag) + ": needs a value"});
  for (const char* flag : {"--size", "--camera", "--fov"})
    expectRefused({"render", "scene.gltf", "-o", "a.png", flag, "1", flag, "2"},
                  {std::string(flag) + ": may be given once"});
  for (const char* flag : {"--camera", "--view", "--animation", "--cache", "--layers", "--stats", "--environment"})
    expectRefused({"render", "scene.gltf", "-o", "a.png", flag, ""}, {flag, "names no"});
  expectRefused({"bake", "scene.gltf", "-o", "a.bricks", "--node", ""}, {"--node: names nothing"});
  expectRefused({"render", "scene.gltf", "-o=a.png"}, {"-o", "=a.png", "after a blank"});
}

TEST_F(CommandLine, RefusesInputsThatAreNoScene) {
  for (const char* command : {"render", "reference"}) {
    expectRefused({command, "absent.glb", "-o", "a.png"}, {"absent.glb", "no such file"});
    expectRefused({command, ".", "-o", "a.png"}, {"."});
    expectRefused({command, "text.glb", "-o", "a.png"}, {"text.glb"});
    expectRefused({command, "text.txt", "-o", "a.png"}, {"text.txt"});
    expectRefused({command, "", "-o", "a.png"}, {"SCENE"});
  }
  expectRefused({"bake", "absent.glb", "-o", "a.bricks"}, {"absent.glb", "no such file"});
  expectRefused({"bake", "text.glb", "-o", "a.bricks"}, {"text.glb"});
  expectRefused({"bake", "text.bricks", "-o", "a.bricks"}, {"text.bricks", "expected .gltf or .glb"});
  expectRefused({"bake", "folder.png", "-o", "a.bricks"}, {"folder.png: is a folder, not a regular file"});
  expectRefused({"list", "cameras", "text.txt"}, {"text.txt", "expected .gltf or .glb"});
  expectRefused({"inspect", "text.bricks", "--against", "text.txt"}, {"text.txt", "expected .gltf or .glb"});
  expectRefused({"list", "cameras", "absent.glb"}, {"absent.glb"});
  expectRefused({"inspect", "absent.bricks"}, {"absent.bricks", "no such file"});
  expectRefused({"inspect", "text.bricks"}, {"text.bricks"});
  expectRefused({"inspect", "."}, {"."});
}

TEST_F(CommandLine, RefusesFlagsOfObjectsWhereThereAreNone) {
  for (const char* command : {"render", "reference"})
    expectRefused({command, "scene.gltf", "-o", "a.png", "--sdf", "none", "--triplanar", "1"},
                  {"--triplanar", "SDF objects"});
}

TEST_F(CommandLine, RefusesOutputsThatCannotBeWritten) {
  for (const char* command : {"render", "reference"}) {
    expectRefused({command, "scene.gltf", "-o", "nowhere/a.png"}, {"nowhere/a.png", "folder does not exist"});
    expectRefused({command, "scene.gltf", "-o", "a.gif"}, {"a.gif", ".png"});
    expectRefused({command, "scene.gltf", "-o", "a"}, {"a", "extension"});
    expectRefused({command, "scene.gltf", "-o", "folder.png"}, {"folder.png", "folder"});
    expectRefused({command, "scene.gltf", "-o", ""}, {"-o"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--layers", "b.png"}, {"b.png", ".exr"});
    expectRefused({command, "scene.gltf", "-o", "a.exr", "--layers", "a.exr"}, {"a.exr", "--layers"});
  }
  expectRefused({"render", "scene.gltf", "-o", "a.png", "--stats", "s.txt"}, {"s.txt", ".json"});
  expectRefused({"bake", "scene.gltf", "-o", "a.glb", "--node", "Left"}, {"a.glb", ".bricks"});
  if (::geteuid() != 0) { // root may write anywhere
    fs::create_directory(folder_ / "locked");
    fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    expectRefused({"render", "scene.gltf", "-o", "locked/a.png"}, {"locked/a.png", "cannot be written"});
  }
}

TEST_F(CommandLine, RefusesValuesOutOfRange) {
  const auto refuse = [&](const char* command, const char* flag, const char* value) {
    const char* output = command == std::string("bake") ? "a.bricks" : "kept.png";
    expectRefused({command, "scene.gltf", "-o", output, flag, value}, {flag});
  };
  for (const char* command : {"render", "reference"}) {
    for (const char* size : {"", "12", "0x5", "5x0", "16385x5", "-4x4", "axb", "1x2x3"})
      refuse(command, "--size", size);
    for (const char* vector : {"1,2", "1,2,3,4", "a,b,c", "1,2,nan", ""}) refuse(command, "--eye", vector);
    for (const char* angle : {"0", "180", "-1", "nan", "wide"}) refuse(command, "--fov", angle);
    for (const char* time : {"nan", "inf", "soon"}) refuse(command, "--time", time);
    for (const char* resolution : {"7", "1025", "1.5", "many"}) refuse(command, "--resolution", resolution);
    for (const char* threads : {"-1", "1025", "x"}) refuse(command, "--threads", threads);
    for (const char* seed : {"-1", "x", "99999999999999999999"}) refuse(command, "--seed", seed);
    for (const char* exposure : {"65", "nan", "x"}) refuse(command, "--exposure", exposure);
    for (const char* light : {"sun", "sun:0,0,0:1:1", "moon:1,2,3:1:1", "sphere:1,2,3:-1:1", ""})
      refuse(command, "--light", light);
    for (const char* pattern : {"Cat*", "", "all,Left"}) refuse(command, "--sdf", pattern);
    for (const char* metres : {"0", "-1", "wide"}) refuse(command, "--triplanar", metres);
    for (const char* model : {"", "phong"}) refuse(command, "--brdf", model);
  }
  for (const char* frames : {"0", "-1", "x", "100001"}) refuse("render", "--frames", frames);
  for (const char* trace : {"", "rays"}) refuse("render", "--trace", trace);
  for (const char* device : {"-1", "x"}) refuse("render", "--device", device);
  for (const char* light : {"", "yes", "0.5", "2:1,1,1", "0.5:1,1,-1"}) refuse("render", "--translucency", light);
  for (const char* method : {"", "ssr"}) refuse("render", "--reflections", method);
  for (const char* shutter : {"-0.1", "1.1", "x", "0.5"})
    refuse("render", "--motion-blur", shutter);                                          // without --taa on
  for (const char* view : {"thickness", "reflection"}) refuse("render", "--view", view); // of what is off
  for (const char* view : {"sideways"}) refuse("render", "--view", view);
  for (const char* samples : {"0", "65537", "x"}) refuse("reference", "--samples", samples);
  for (const char* resolution : {"7", "1025"}) refuse("bake", "--resolution", resolution);
  for (const char* bits : {"9", "0", "x"}) refuse("bake", "--bits", bits);
  for (const char* mips : {"0", "5"}) refuse("bake", "--mips", mips);
  for (const char* sign : {"", "maybe"}) refuse("bake", "--sign", sign);
  for (const char* thickness : {"-1", "nan"}) refuse("bake", "--thickness", thickness);
}

TEST_F(CommandLine, RefusesCamerasThatAreNot) {
  for (const char* command : {"render", "reference"}) {
    expectRefused({command, "scene.gltf", "-o", "a.png", "--eye", "1,2,3"}, {"--eye", "--target"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--target", "1,2,3"}, {"--target", "--eye"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--eye", "1,2,3", "--target", "1,2,3"}, {"same point"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--camera", "seven"}, {"seven"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--camera", "auto", "--eye", "1,2,3", "--target", "0,0,0"},
                  {"--camera: auto", "--eye"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--animation", "Dance", "--time", "1"}, {"Dance"});
  }
}

TEST_F(CommandLine, RefusesEnvironmentsThatAreNone) {
  for (const char* command : {"render", "reference"})
    for (const char* file : {"absent.hdr", "text.hdr", "text.exr", "text.png", ".", ""})
      expectRefused({command, "scene.gltf", "-o", "a.png", "--environment", file},
                    {*file ? std::string(file) : "--environment"});
}

TEST_F(CommandLine, RefusesMeshesThatAreNotClear) {
  expectRefused({"bake", "scene.gltf", "-o", "a.bricks"}, {"--node", "Left", "Right"});
  expectRefused({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Middle"}, {"--node", "Middle"});
}

TEST_F(CommandLine, RefusesPicturesThatCannotBeCompared) {
  expectRefused({"compare", "text.png", "absent.png"}, {"absent.png"});
  expectRefused({"compare", "text.png", "text.png"}, {"text.png"});
  expectRefused({"compare", "text.exr", "text.exr"}, {"text.exr"});
  expectRefused({"compare", "text.png", "text.exr"}, {"text.exr"});
  expectRefused({"compare", "text.txt", "text.txt"}, {"text.txt"});
  expectRefused({"compare", "text.png", "text.png", "--metric", "psnr"}, {"--metric", "psnr"});
  expectRefused({"compare", "text.png", "text.png", "--tolerance", "-1"}, {"--tolerance"});
  expectRefused({"compare", "text.png", "text.png", "--heatmap", "h.exr"}, {"h.exr"});
}

TEST_F(CommandLine, BakesInspectsTracesAndCompares) {
  const auto expectDone = [&](const std::vector<std::string>& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
    return result.output;
  };
  expectDone({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Left", "--resolution", "16", "--stats", "bake.json"});
  const std::vector<std::byte> stats = readFile(folder_ / "bake.json");
  EXPECT_EQ(nlohmann::json::parse(reinterpret_cast<const char*>(stats.data()),
                                  reinterpret_cast<const char*>(stats.data() + stats.size()))["triangles"],
            12);
  EXPECT_THAT(expectDone({"inspect", "a.bricks", "--slice", "x:0", "-o", "slice.png", "--json", "i.json", "--against",
                          "scene.gltf", "--node", "Left"}),
              HasSubstr("against scene.gltf"));
  expectRefused({"inspect", "a.bricks", "--slice", "x:9", "-o", "b.png"}, {"--slice", "x:9"});
  expectRefused({"inspect", "a.bricks", "--slice", "w:0", "-o", "b.png"}, {"--slice", "w:0"});
  expectRefused({"inspect", "a.bricks", "--slice", "x:0"}, {"--slice", "-o"});
  expectRefused({"inspect", "a.bricks", "-o", "b.png"}, {"-o", "--slice"});

  expectDone({"reference", "scene.gltf", "-o", "a.exr", "--layers", "la.exr", "--size", "32x16"});
  expectDone({"reference", "scene.gltf", "-o", "b.exr", "--layers", "lb.exr", "--size", "32x16", "--light", "none"});
  expectDone({"reference", "scene.gltf", "-o", "small.exr", "--size", "16x16"});
  EXPECT_THAT(expectDone({"compare", "a.exr", "a.exr", "--tolerance", "0"}), HasSubstr("color: rmse 0,"));
  expectDone({"compare", "la.exr", "lb.exr", "--layer", "depth", "--layer", "id", "--tolerance", "0"});
  const ProgramResult over = run({"compare", "la.exr", "lb.exr", "--tolerance", "1e-3", "--heatmap", "heat.png"});
  EXPECT_EQ(over.exitCode, 1);
  EXPECT_THAT(over.output, HasSubstr("over tolerance"));
  EXPECT_TRUE(fs::exists(folder_ / "heat.png"));
  expectRefused({"compare", "a.exr", "small.exr"}, {"small.exr", "size"});
  expectRefused({"compare", "la.exr", "lb.exr", "--layer", "glow"}, {"la.exr", "glow"});
}

TEST_F(CommandLine, ScenesAreNamedAsTheyWereTyped) {
  folder_.write("inner/broken.gltf", "{\n  \"asset\" {}}");
  const std::string broken = "inner/broken.gltf: JSON: line 2, column 11: unexpected '{'; expected ':'\n";
  folder_.write("inner/bare.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "b.bin"}]})");
  const std::string bare = "brickfield: ./inner/bare.gltf: buffer 0: uri \"b.bin\": no such file\n";
  for (const std::vector<std::string>& tail :
       {std::vector<std::string>{"-o", "a.png"}, {"-o", "a.png", "--sdf", "all"}})
    for (const char* command : {"render", "reference"}) {
      std::vector<std::string> arguments{command, "inner/broken.gltf"};
      arguments.insert(arguments.end(), tail.begin(), tail.end());
      expectRefused(arguments, {broken});
      arguments[1] = "./inner/bare.gltf";
      expectRefused(arguments, {bare});
    }
  expectRefused({"bake", "inner/broken.gltf", "-o", "a.bricks"}, {broken});
  expectRefused({"list", "cameras", "inner/broken.gltf"}, {broken});
  expectRefused({"render", (folder_ / "scene.gltf").string(), "-o", "a.png", "--camera", "7"},
                {"brickfield: " + (folder_ / "scene.gltf").string() + ": camera"});
}

TEST_F(CommandLine, InputsThatWouldBlockAreRefused) {
  for (const char* end : {".glb", ".gltf", ".bricks", ".png", ".exr", ".hdr"})
    ASSERT_EQ(::mkfifo((folder_ / (std::string("pipe") + end)).c_str(), 0600), 0);
  const std::string reason = "is a named pipe, not a regular file";
  for (const char* scene : {"pipe.glb", "pipe.gltf"}) {
    for (const char* command : {"render", "reference"}) expectRefused({command, scene, "-o", "a.png"}, {scene, reason});
    expectRefused({"bake", scene, "-o", "a.bricks"}, {scene, reason});
    expectRefused({"list", "cameras", scene}, {scene, reason});
    expectRefused({"inspect", "text.bricks", "--against", scene}, {scene, reason});
  }
  for (const char* light : {"pipe.exr", "pipe.hdr"})
    expectRefused({"render", "scene.gltf", "-o", "a.png", "--environment", light}, {light, reason});
  for (const char* picture : {"pipe.png", "pipe.exr"}) expectRefused({"compare", picture, picture}, {picture, reason});
  expectRefused({"inspect", "pipe.bricks"}, {"pipe.bricks", reason});
  fs::remove(folder_ / "scene.bin");
  ASSERT_EQ(::mkfifo((folder_ / "scene.bin").c_str(), 0600), 0);
  expectRefused({"render", "scene.gltf", "-o", "a.png"}, {"scene.gltf: buffer 0: uri \"scene.bin\": " + reason});
}

TEST_F(CommandLine, ListOfCamerasSaysNothingOfMeshes) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(folder_ / "scene.gltf"));
  scene["extensionsUsed"] = {"VENDOR_unknown"};
  writeFile(folder_ / "scene.gltf", scene.dump());
  EXPECT_THAT(run({"bake", "scene.gltf", "--node", "Left", "--resolution", "8", "-o", "a.bricks"}).messages,
              HasSubstr("VENDOR_unknown"));
  const ProgramResult result = run({"list", "cameras", "scene.gltf"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.messages, "");
  EXPECT_THAT(result.output, HasSubstr("--camera auto"));
}

TEST_F(CommandLine, PartsTooThinForTheirVoxelsAreNamedInOneLine) {
  // The boxes of 2 m, pressed to 2 cm; a voxel is 1/8 m.
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(folder_ / "scene.gltf"));
  scene["accessors"][0]["min"][2] = -0.01f;
  scene["accessors"][0]["max"][2] = 0.01f;
  writeFile(folder_ / "scene.gltf", scene.dump());
  std::vector<std::byte> bytes = readFile(folder_ / "scene.bin");
  for (std::size_t vertex = 0; vertex < 8; ++vertex) {
    const float z = vertex < 4 ? -0.01f : 0.01f;
    std::memcpy(bytes.data() + 12 * vertex + 8, &z, sizeof z);
  }
  writeFile(folder_ / "scene.bin", bytes);
  const auto expectOneLine = [](const ProgramResult& result) {
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.messages, ::testing::StartsWith("brickfield: warning: node 0 \"Left\": 98 % of its closed"));
    EXPECT_THAT(result.messages, HasSubstr("thinner than a voxel of 0.12 m"));
    EXPECT_THAT(result.messages, HasSubstr("(--resolution 1"));
    EXPECT_EQ(std::count(result.messages.begin(), result.messages.end(), '\n'), 1) << result.messages;
  };
  expectOneLine(run({"bake", "scene.gltf", "--node", "Left", "--resolution", "16", "-o", "a.bricks"}));
  const std::vector<std::string> render{"render", "scene.gltf", "-o",           "a.png", "--size",  "32x18",
                                        "--sdf",  "all",        "--resolution", "16",    "--cache", "cache"};
  expectOneLine(run(render)); // both nodes share the mesh
  expectOneLine(run(render)); // from the cache
  EXPECT_EQ(run({"bake", "scene.gltf", "--node", "Left", "--resolution", "150", "-o", "a.bricks"}).messages, "");
}

TEST_F(CommandLine, FullDeviceIsNoSuccess) {
  if (!fs::exists("/dev/full")) GTEST_FAIL() << "this machine has no /dev/full";
  const ProgramResult done = run({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Left", "--resolution", "16"});
  ASSERT_EQ(done.exitCode, 0) << done.messages;
  fs::create_symlink("/dev/full", folder_ / "full.json");
  const ProgramResult result = run({"inspect", "a.bricks", "--json", "full.json"});
  EXPECT_NE(result.exitCode, 0);
  EXPECT_THAT(result.messages, HasSubstr("full.json"));
}

} // namespace
} // namespace brickfield::test
