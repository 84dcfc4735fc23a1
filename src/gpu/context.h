// OpenGL 4.5 core contexts through EGL: without a surface (renders, tests, benches), with a window (the viewer), or the
// host application's own. There are no globals: several contexts may live in one process, each current in one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace brickfield {

class Window;

/// What a driver says about itself.
struct ContextInfo {
  std::string renderer;
  std::string vendor;
  std::string version;
  std::string glslVersion;
  std::string platform;    ///< how the context was made: "EGL device 0", "EGL surfaceless", "window", "host"
  bool isSoftware = false; ///< a rasterizer on the CPU (llvmpipe, softpipe, SwiftShader)
};

/// One EGL device; `error` is empty where a 4.5 core context can be made on it, else `context` holds only the platform.
struct DeviceInfo {
  int index = 0;
  ContextInfo context;
  std::string error;
};

#ifdef NDEBUG
inline constexpr bool kDebugContextByDefault = false;
#else
inline constexpr bool kDebugContextByDefault = true;
#endif

struct WindowOptions {
  std::string title = "Brickfield";
  int width = 1280; ///< in screen coordinates; the framebuffer may be larger
  int height = 720;
  bool visible = true;
  bool verticalSync = true;
  bool debug = kDebugContextByDefault;
};

/// An OpenGL context. While it is current in a thread, the other classes of this room work on it; their objects must be
/// destroyed while it (or one that shares with it) is current.
class Context {
public:
  /// A context without any surface, made current in the calling thread.
  ///
  /// device  index into EGL's devices; -1 picks: hardware devices in order, then software ones, then Mesa's surfaceless
  ///         platform
  /// debug   ask for a debug context, whose messages of errors and of high severity takeGlErrors() returns
  /// error   BadInput, one line that says everything that was tried and why each failed, or which function is missing
  /// proved by tests/gpu/gpu/context_test.cpp
  static std::unique_ptr<Context> createHeadless(int device = -1, bool debug = kDebugContextByDefault);

  /// A window with its context, made current. GLFW allows this in the main thread only.
  /// error   BadInput: no display, no EGL, or no 4.5 core context
  static std::unique_ptr<Context> createWindow(const WindowOptions& options);

  /// Wraps the host application's current context; owns nothing and changes no state (no debug callback either).
  /// error   BadInput where no context is current, or it is not 4.5 or newer
  static std::unique_ptr<Context> adoptCurrent();

  virtual ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes it current in the calling thread; it must not be current in another one. Nothing for a host's context.
  virtual void makeCurrent() = 0;
  /// Afterwards no context is current in the calling thread. Nothing for a host's context.
  virtual void release() = 0;
  /// Null unless made by createWindow.
  virtual Window* window() { return nullptr; }

  const ContextInfo& info() const { return info_; }

  /// GL errors since the last call: pending glGetError codes and what the debug output reported as an error or as of
  /// high severity (at most kMostErrors texts are kept). The context must be current.
  std::vector<std::string> takeGlErrors();
  /// How many messages the debug output has reported as errors or of high severity, ever; 0 without debug output.
  std::uint64_t debugErrorCount() const;

  static constexpr std::size_t kMostErrors = 64;

protected:
  Context();
  /// Checks version and functions of the context that is current, fills info(), installs the debug callback on request.
  void adopt(std::string platform, bool debug, bool softwareDevice);

private:
  struct ErrorLog;
  ContextInfo info_;
  std::unique_ptr<ErrorLog> errors_;
};

/// Every EGL device with what a context on it says; the calling thread's current context stays as it was.
std::vector<DeviceInfo> listDevices();

} // namespace brickfield
