// A GLFW window with its context: through EGL, as everywhere, else through the window system's own API. GLFW stays
// initialised once it is: ending it would close the host's windows too.
#include <array>
#include <exception>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "core/error.h"
#include "gpu/context.h"
#include "gpu/gl.h"
#include "gpu/window.h"

namespace brickfield {

namespace {

constexpr const char* kSubject = "OpenGL 4.5 window";

std::string glfwErrorText() {
  const char* text = nullptr;
  return glfwGetError(&text) != GLFW_NO_ERROR && text ? text : "no reason given";
}

GLFWwindow* openWindow(const WindowOptions& options, int contextApi) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, contextApi);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0); // Frames are rendered into textures and copied.
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  return glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
}

// Window and context are one object of GLFW.
class GlfwWindow final : public Context, public Window {
public:
  explicit GlfwWindow(const WindowOptions& options) {
    if (options.width < 1 || options.height < 1)
      throw BadInput(kSubject, "", fmt::format("a size of {}x{} is not possible", options.width, options.height));
    if (!glfwInit()) throw BadInput(kSubject, "", fmt::format("no display: {}", glfwErrorText()));
    const char* platform = "window (EGL)";
    window_ = openWindow(options, GLFW_EGL_CONTEXT_API);
    if (!window_) {
      const std::string eglReason = glfwErrorText();
      platform = "window (native)";
      window_ = openWindow(options, GLFW_NATIVE_CONTEXT_API);
      if (!window_)
        throw BadInput(kSubject, "", fmt::format("EGL: {}; the window system's own: {}", eglReason, glfwErrorText()));
    }
    try {
      GlfwWindow::makeCurrent();
      adopt(platform, options.debug, false);
    } catch (...) {
      glfwDestroyWindow(window_);
      throw;
    }
    glfwSwapInterval(options.verticalSync ? 1 : 0);
    installCallbacks();
  }
  ~GlfwWindow() override { glfwDestroyWindow(window_); }

  void makeCurrent() override { glfwMakeContextCurrent(window_); }
  void release() override {
    if (glfwGetCurrentContext() == window_) glfwMakeContextCurrent(nullptr);
  }
  Window* window() override { return this; }

  void setEvents(WindowEvents events) override { events_ = std::move(events); }
  void poll() override {
    glfwPollEvents();
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }
  void swap() override { glfwSwapBuffers(window_); }
  bool shouldClose() const override { return glfwWindowShouldClose(window_); }
  void requestClose() override { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
  glm::ivec2 framebufferSize() const override {
    glm::ivec2 size{0};
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
  }
  bool isKeyDown(int key) const override { return glfwGetKey(window_, key) == GLFW_PRESS; }
  bool isMouseDown(MouseButton button) const override {
    return glfwGetMouseButton(window_, static_cast<int>(button)) == GLFW_PRESS;
  }
  glm::vec2 mousePosition() const override {
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    return inPixels(x, y);
  }
  void capturePointer(bool captured) override {
    glfwSetInputMode(window_, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  }
  void setTitle(const char* title) override { glfwSetWindowTitle(window_, title); }

private:
  // GLFW speaks in screen coordinates, which on some displays are several pixels.
  glm::vec2 inPixels(double x, double y) const {
    glm::ivec2 size{0};
    glfwGetWindowSize(window_, &size.x, &size.y);
    const glm::vec2 pixels(framebufferSize());
    return glm::vec2(x, y) * pixels / glm::max(glm::vec2(size), glm::vec2(1));
  }

  // Calls a callback; an exception waits until GLFW, which is C, has returned.
  template <typename Call>
  static void guarded(GLFWwindow* window, const Call& call) {
    auto* self = static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
    try {
      call(*self);
    } catch (...) {
      if (!self->thrown_) self->thrown_ = std::current_exception();
    }
  }

  void installCallbacks() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
      guarded(window, [&](GlfwWindow& self) {
        if (self.events_.onKey) self.events_.onKey(key, action != GLFW_RELEASE, action == GLFW_REPEAT);
      });
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
      guarded(window, [&](GlfwWindow& self) {
        if (self.events_.onMouseButton && button <= static_cast<int>(MouseButton::Middle))
          self.events_.onMouseButton(static_cast<MouseButton>(button), action == GLFW_PRESS, self.mousePosition());
      });
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
      guarded(window, [&](GlfwWindow& self) {
        if (self.events_.onMouseMove) self.events_.onMouseMove(self.inPixels(x, y));
      });
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
      guarded(window, [&](GlfwWindow& self) {
        if (self.events_.onScroll) self.events_.onScroll(glm::vec2(x, y));
      });
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
      guarded(window, [&](GlfwWindow& self) {
        if (self.events_.onDrop) self.events_.onDrop(std::vector<std::filesystem::path>(paths, paths + count));
      });
    });
  }

  GLFWwindow* window_ = nullptr;
  WindowEvents events_;
  std::exception_ptr thrown_;
};

} // namespace

std::unique_ptr<Context> Context::createWindow(const WindowOptions& options) {
  return std::make_unique<GlfwWindow>(options);
}

} // namespace brickfield
