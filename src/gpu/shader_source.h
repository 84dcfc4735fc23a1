// From shader files to the text that a driver compiles: includes, version, defines. No GL call is made here.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace brickfield {

struct ShaderText {
  std::string text;
  std::vector<std::string> files; ///< relative to the root; index is the source string number in #line
};

/// When files were last written, as seen before they were read; min() for a missing one. Paths relative to the root.
using FileTimes = std::map<std::string, std::filesystem::file_time_type>;

/// What stands before the file's own text, in this order: #version 450 core, the extensions (required), BRICKFIELD_GLSL
/// 1 and the defines.
struct ShaderPreamble {
  std::vector<std::string> extensions; ///< "GL_ARB_shader_draw_parameters"
  std::map<std::string, std::string> defines;
};

/// Reads a shader and resolves `#include "lib/x.glsl"`, always relative to the root. A file enters once, where it is
/// first included, whatever its guards say. Lines `#include <...>` and includes in C++ halves (`#ifdef __cplusplus`)
/// are left out, so that headers of shaders/shared serve both languages. Elsewhere an include must not stand inside a
/// condition (an include guard is none).
///
/// visited if given, gets every file that was looked for, also when it fails: what to watch for a better try
/// error   Failure that names file:line: missing file, a path out of the root, a cycle (with its chain), an include
/// inside
///         a condition, a #version of the file's own
/// proved by tests/gpu/gpu/shader_source_test.cpp
ShaderText assembleShader(const std::filesystem::path& root, std::string_view path, const ShaderPreamble& preamble,
                          FileTimes* visited = nullptr);

/// The time for FileTimes. root/path need not exist.
std::filesystem::file_time_type changeTime(const std::filesystem::path& path);

/// A compiler's log with its source numbers replaced by file names, one entry a message: "lib/noise.glsl:12: ...".
/// Understands the forms of Mesa "1:12(3): error", NVIDIA "1(12) : error" and AMD or Intel "ERROR: 1:12:".
std::vector<std::string> readableLog(std::string_view log, const std::vector<std::string>& files);

} // namespace brickfield
