// What all contexts share: the check of version and functions, and the collection of GL errors. How contexts are made
// is in egl_context.cpp and window_context.cpp.
#include "gpu/context.h"

#include <dlfcn.h>

#include <atomic>
#include <mutex>
#include <string_view>
#include <utility>

#include <epoxy/egl.h>
#include <fmt/format.h>

#include "core/error.h"
#include "gpu/gl.h"

namespace brickfield {

struct Context::ErrorLog {
  std::mutex mutex;
  std::vector<std::string> texts;
  std::atomic<std::uint64_t> count{0};
};

namespace {

constexpr const char* kSubject = "OpenGL 4.5 context";

// One function of every feature newer than 3.3 that the renderer rests on. epoxy aborts the process on a function that
// the driver lacks, so a driver that claims 4.5 without them must be turned down here.
constexpr const char* kRequiredFunctions[] = {
    "glCreateTextures",
    "glCreateBuffers",
    "glCreateFramebuffers",
    "glCreateVertexArrays",
    "glCreateQueries",
    "glNamedBufferStorage",
    "glTextureStorage3D",
    "glGetTextureSubImage",
    "glGetTextureImage",
    "glClearNamedBufferData",
    "glClearTexImage",
    "glBindTextureUnit",
    "glBindImageTexture",
    "glMemoryBarrier",
    "glDispatchCompute",
    "glDispatchComputeIndirect",
    "glMultiDrawArraysIndirect",
    "glDrawElementsIndirect",
    "glClipControl",
    "glPushDebugGroup",
    "glObjectLabel",
    "glDebugMessageCallback",
    "glProgramUniform1i",
    "glGetProgramResourceiv",
    "glShaderStorageBlockBinding",
    "glQueryCounter",
    "glFramebufferParameteri",
    "glBlitNamedFramebuffer",
    "glInvalidateNamedFramebufferData",
    "glViewportIndexedf",
    "glGenSamplers",
    "glGetInternalformativ",
};

bool isSoftwareRenderer(std::string_view renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"})
    if (renderer.find(name) != std::string_view::npos) return true;
  return false;
}

std::string textOf(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

// GLX is no dependency of ours: only a host that uses it has it loaded.
void* glxSymbol(const char* name) {
  for (const char* library : {"libGLX.so.0", "libGL.so.1"})
    if (void* handle = ::dlopen(library, RTLD_LAZY | RTLD_NOLOAD)) {
      void* symbol = ::dlsym(handle, name);
      ::dlclose(handle);
      if (symbol) return symbol;
    }
  return nullptr;
}

// epoxy ends the process where EGL's library is missing, as it may be for a host that uses GLX.
bool isEglContextCurrent() {
  void* library = ::dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
  if (!library) return false;
  ::dlclose(library);
  return eglGetCurrentContext() != EGL_NO_CONTEXT;
}

bool isGlxContextCurrent() {
  using GetCurrent = void* (*)();
  const auto getCurrent = reinterpret_cast<GetCurrent>(glxSymbol("glXGetCurrentContext"));
  return getCurrent && getCurrent();
}

bool hasFunction(const char* name, bool glx) {
  if (!glx) return eglGetProcAddress(name) != nullptr;
  using Lookup = void (*(*)(const GLubyte*))();
  const auto lookup = reinterpret_cast<Lookup>(glxSymbol("glXGetProcAddressARB"));
  return lookup && lookup(reinterpret_cast<const GLubyte*>(name));
}

const char* errorName(GLenum code) {
  switch (code) {
  case GL_INVALID_ENUM:
    return "GL_INVALID_ENUM";
  case GL_INVALID_VALUE:
    return "GL_INVALID_VALUE";
  case GL_INVALID_OPERATION:
    return "GL_INVALID_OPERATION";
  case GL_INVALID_FRAMEBUFFER_OPERATION:
    return "GL_INVALID_FRAMEBUFFER_OPERATION";
  case GL_OUT_OF_MEMORY:
    return "GL_OUT_OF_MEMORY";
  case GL_STACK_OVERFLOW:
    return "GL_STACK_OVERFLOW";
  case GL_STACK_UNDERFLOW:
    return "GL_STACK_UNDERFLOW";
  case GL_CONTEXT_LOST:
    return "GL_CONTEXT_LOST";
  default:
    return "unknown GL error";
  }
}

// The host's context: nothing is owned, nothing is switched.
class HostContext final : public Context {
public:
  HostContext() { adopt("host", false, false); }
  void makeCurrent() override {}
  void release() override {}
};

} // namespace

Context::Context() : errors_(std::make_unique<ErrorLog>()) {}
Context::~Context() = default;

std::unique_ptr<Context> Context::adoptCurrent() {
  if (!isEglContextCurrent() && !isGlxContextCurrent())
    throw BadInput(kSubject, "host", "no context is current in this thread");
  return std::make_unique<HostContext>();
}

void Context::adopt(std::string platform, bool debug, bool softwareDevice) {
  info_ = {textOf(GL_RENDERER), textOf(GL_VENDOR), textOf(GL_VERSION), textOf(GL_SHADING_LANGUAGE_VERSION),
           std::move(platform), softwareDevice};
  info_.isSoftware = softwareDevice || isSoftwareRenderer(info_.renderer);

  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (info_.version.find("OpenGL ES") != std::string::npos || major < 4 || (major == 4 && minor < 5))
    throw BadInput(kSubject, info_.platform, fmt::format("{} is only version \"{}\"", info_.renderer, info_.version));

  const bool glx = !isEglContextCurrent();
  for (const char* name : kRequiredFunctions)
    if (!hasFunction(name, glx))
      throw BadInput(kSubject, info_.platform, fmt::format("{} lacks the function {}", info_.renderer, name));
  if (!debug) return;

  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  const GLDEBUGPROC collect = [](GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                                 const GLchar* message, const void* user) {
    // The compiler's errors are reported where a program is made; a reload that fails is no fault of the GL code.
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
    if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
    auto* log = static_cast<ErrorLog*>(const_cast<void*>(user));
    ++log->count;
    try {
      const std::lock_guard lock(log->mutex);
      if (log->texts.size() < kMostErrors)
        log->texts.push_back(length < 0 ? std::string(message)
                                        : std::string(message, static_cast<std::size_t>(length)));
    } catch (const std::bad_alloc&) { // Nothing may be thrown into the driver; the count tells of the message.
    }
  };
  glDebugMessageCallback(collect, errors_.get());
}

std::vector<std::string> Context::takeGlErrors() {
  std::vector<std::string> taken;
  {
    const std::lock_guard lock(errors_->mutex);
    taken.swap(errors_->texts);
  }
  // A lost context may report an error for ever.
  for (std::size_t i = 0; i < kMostErrors; ++i) {
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) break;
    taken.push_back(errorName(code));
  }
  return taken;
}

std::uint64_t Context::debugErrorCount() const { return errors_->count.load(); }

} // namespace brickfield
