// Uniforms of every type arrive, and the driver's view of a block is told right.
#include "gpu/program.h"

#include "core/error.h"
#include "gpu/buffer.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

class ProgramTest : public GlTest {};

Program compute(const std::string& body) {
  return Program("test", {{GL_COMPUTE_SHADER, "#version 450 core\n" + body, {"test.glsl"}}});
}

TEST_F(ProgramTest, UniformsOfEveryTypeArrive) {
  Program program = compute(R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) buffer Result { float result[]; };
    uniform bool flag; uniform int i; uniform uint u; uniform float f;
    uniform vec2 v2; uniform vec3 v3; uniform vec4 v4;
    uniform ivec2 i2; uniform ivec3 i3; uniform ivec4 i4;
    uniform uvec2 u2; uniform uvec3 u3; uniform uvec4 u4;
    uniform mat3 m3; uniform mat4 m4; uniform float fs[3]; uniform vec4 vs[2];
    void main() {
      result[0] = float(flag); result[1] = float(i); result[2] = float(u); result[3] = f;
      result[4] = v2.y; result[5] = v3.z; result[6] = v4.w;
      result[7] = float(i2.y); result[8] = float(i3.z); result[9] = float(i4.w);
      result[10] = float(u2.y); result[11] = float(u3.z); result[12] = float(u4.w);
      result[13] = m3[2][0]; result[14] = m4[3][1]; result[15] = fs[2]; result[16] = vs[1].z;
    })");
  program.set("flag", true);
  program.set("i", -1);
  program.set("u", 2u);
  program.set("f", 3.5f);
  program.set("v2", glm::vec2(0, 4));
  program.set("v3", glm::vec3(0, 0, 5));
  program.set("v4", glm::vec4(0, 0, 0, 6));
  program.set("i2", glm::ivec2(0, -7));
  program.set("i3", glm::ivec3(0, 0, -8));
  program.set("i4", glm::ivec4(0, 0, 0, -9));
  program.set("u2", glm::uvec2(0, 10));
  program.set("u3", glm::uvec3(0, 0, 11));
  program.set("u4", glm::uvec4(0, 0, 0, 12));
  glm::mat3 m3(0);
  m3[2][0] = 13;
  glm::mat4 m4(0);
  m4[3][1] = 14;
  program.set("m3", m3);
  program.set("m4", m4);
  program.set("fs", std::vector<float>{0, 0, 15});
  program.set("vs", std::vector<glm::vec4>{glm::vec4(0), glm::vec4(0, 0, 16, 0)});
  program.set("unused", 1.0f); // names that a variant dropped are ignored
  EXPECT_TRUE(program.hasUniform("f"));
  EXPECT_FALSE(program.hasUniform("unused"));

  const Buffer result("result", std::vector<float>(17, -100));
  result.bindStorage(0);
  program.dispatchOver({1, 1, 1});
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  EXPECT_EQ(result.read<float>(),
            (std::vector<float>{1, -1, 2, 3.5f, 4, 5, 6, -7, -8, -9, 10, 11, 12, 13, 14, 15, 16}));
}

TEST_F(ProgramTest, WrongUniformTypeIsAGlError) {
  Program program = compute("layout(local_size_x = 1) in; layout(std430, binding = 0) buffer R { float r; };"
                            "uniform float f; void main() { r = f; }");
  program.set("f", glm::vec3(1));
  EXPECT_FALSE(context().takeGlErrors().empty());
}

TEST_F(ProgramTest, BlocksAreToldAsTheDriverLaysThemOut) {
  const Program program = compute(R"(
    layout(local_size_x = 1) in;
    layout(std140, binding = 0) uniform Params { vec3 eye; float near; mat4 clip; } params;
    struct Item { vec3 low; float pad; uint id; };
    layout(std430, binding = 1) buffer Items { uint count; Item items[]; };
    void main() { items[0].low = params.eye * params.near * params.clip[0].x; items[0].id = count; items[0].pad = 1.0; })");
  const Program::BlockLayout params = program.blockLayout("Params", false);
  EXPECT_EQ(params.offsets.at("Params.eye"), 0);
  EXPECT_EQ(params.offsets.at("Params.near"), 12);
  EXPECT_EQ(params.offsets.at("Params.clip"), 16);
  EXPECT_EQ(params.bytes, 80);
  const Program::BlockLayout items = program.blockLayout("Items", true);
  EXPECT_EQ(items.offsets.at("count"), 0);
  EXPECT_EQ(items.offsets.at("items[0].low"), 16);
  EXPECT_EQ(items.offsets.at("items[0].id"), 32);
  EXPECT_EQ(items.arrayStride, 32);
  EXPECT_THROW(program.blockLayout("None", true), Failure);
}

TEST_F(ProgramTest, DispatchCoversAllInvocationsInWholeGroups) {
  const Program program = compute("layout(local_size_x = 8, local_size_y = 4) in;"
                                  "layout(std430, binding = 0) buffer R { uint most[2]; };"
                                  "void main() { atomicMax(most[0], gl_GlobalInvocationID.x + 1u);"
                                  "atomicMax(most[1], gl_GlobalInvocationID.y + 1u); }");
  EXPECT_EQ(program.groupSize(), glm::ivec3(8, 4, 1));
  Buffer most("most", std::vector<std::uint32_t>{0, 0});
  most.bindStorage(0);
  program.dispatchOver({17, 4, 1});
  program.dispatchOver({0, 100, 1}); // nothing to do is no error
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  EXPECT_EQ(most.read<std::uint32_t>(), (std::vector<std::uint32_t>{24, 4}));
}

TEST_F(ProgramTest, DestructionFreesIt) {
  GLuint id = 0;
  {
    const Program program = compute("layout(local_size_x = 1) in; void main() {}");
    id = program.id();
    EXPECT_TRUE(glIsProgram(id));
  }
  EXPECT_FALSE(glIsProgram(id));
}

} // namespace
} // namespace brickfield::test
