// Runs a small compute shader of a test over rows of vec4, with the includes of the real shader folder: how functions
// of shaders/lib meet their C++ twins.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/buffer.h"
#include "gpu/shader_library.h"
#include "shared/bindings.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {

class ShaderBench {
public:
  ShaderBench() {
    for (const char* part : {"lib", "shared"})
      std::filesystem::create_directory_symlink(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders" / part,
                                                root_ / part);
  }

  /// A whole compute shader.
  std::shared_ptr<Program> loadWhole(const std::string& text) {
    const std::string name = "test" + std::to_string(count_++) + ".comp.glsl";
    root_.write(name, text);
    if (!library_) library_ = std::make_unique<ShaderLibrary>(root_.path());
    return library_->load({name, {{GL_COMPUTE_SHADER, name}}, {}, {}});
  }

  /// includes lines of #include; body what computes the rows `outputs[]` of an `index` from the rows `inputs[]`.
  std::shared_ptr<Program> load(const std::string& includes, const std::string& body) {
    return loadWhole("#include \"shared/bindings.h\"\n" + includes + R"(
layout(local_size_x = 64) in;
layout(std430, binding = kPassBufferABinding) readonly buffer InputBlock { vec4 inputs[]; };
layout(std430, binding = kPassBufferBBinding) writeonly buffer OutputBlock { vec4 outputs[]; };
uniform uint count;
void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
)" + body + "\n}\n");
  }

  /// Runs a program of load() over `count` indices; returns rowsEach rows an index.
  static std::vector<glm::vec4> run(Program& program, const std::vector<glm::vec4>& inputs, std::size_t count,
                                    std::size_t rowsEach) {
    const Buffer in("test_inputs", inputs);
    const Buffer out("test_outputs", count * rowsEach * sizeof(glm::vec4));
    in.bindStorage(shared::kPassBufferABinding);
    out.bindStorage(shared::kPassBufferBBinding);
    program.set("count", static_cast<std::uint32_t>(count));
    program.dispatchOver({static_cast<int>(count), 1, 1});
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return out.read<glm::vec4>();
  }

private:
  TemporaryFolder root_;
  std::unique_ptr<ShaderLibrary> library_;
  int count_ = 0;
};

} // namespace brickfield::test
