// A window needs a display: without one a clear error, with one (a virtual X server, if the machine has it) a context
// whose default framebuffer can be drawn to.
#include "gpu/window.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/context.h"
#include "gpu/gl.h"
#include "tests/support/data.h"

namespace brickfield::test {
namespace {

// An X server without a screen, on a display number of its choice, while the object lives.
class VirtualDisplay {
public:
  VirtualDisplay() {
    int ends[2];
    if (::pipe(ends) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::close(ends[0]);
      ::execlp("Xvfb", "Xvfb", "-displayfd", std::to_string(ends[1]).c_str(), "-screen", "0", "640x480x24", "-nolisten",
               "tcp", static_cast<char*>(nullptr));
      ::_exit(127);
    }
    ::close(ends[1]);
    std::string number; // The server dies if its reader leaves before the line's end.
    for (char c = 0; ::read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    ::close(ends[0]);
    if (!number.empty()) name_ = ":" + number;
  }
  ~VirtualDisplay() {
    if (process_ <= 0) return;
    if (name_) ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  const std::optional<std::string>& name() const { return name_; }

private:
  pid_t process_ = -1;
  std::optional<std::string> name_;
};

WindowOptions smallWindow() { return {.title = "test", .width = 64, .height = 48, .debug = true}; }

// Exit code of what the command line does with this error, with its text on stderr.
[[noreturn]] void openWithoutDisplay() {
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  try {
    Context::createWindow(smallWindow());
  } catch (const BadInput& error) {
    std::fputs(error.what(), stderr);
    std::exit(std::strchr(error.what(), '\n') ? 1 : 2);
  }
  std::exit(0);
}

TEST(WindowTest, NoDisplayIsBadInput) {
  // In a process of its own: once connected to a display, GLFW stays so.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(openWithoutDisplay(), ::testing::ExitedWithCode(2), "OpenGL 4.5 window: no display: .*DISPLAY");
}

TEST(WindowTest, ImpossibleSizeIsBadInput) {
  WindowOptions options = smallWindow();
  options.width = 0;
  EXPECT_THROW(Context::createWindow(options), BadInput);
}

TEST(WindowTest, WindowDrawsOnAVirtualDisplay) {
  static const VirtualDisplay display; // until the process ends, as GLFW's connection to it does
  if (!display.name()) return reportNotRun("Xvfb missing");
  ::setenv("DISPLAY", display.name()->c_str(), 1);
  const auto context = Context::createWindow(smallWindow());
  Window* window = context->window();
  ASSERT_NE(window, nullptr);
  EXPECT_EQ(context->info().platform.substr(0, 6), "window");
  EXPECT_EQ(window->framebufferSize(), glm::ivec2(64, 48));
  window->setEvents({});
  glClearColor(0, 1, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  unsigned char pixel[4] = {};
  glReadPixels(10, 10, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  EXPECT_EQ(pixel[0], 0);
  EXPECT_EQ(pixel[1], 255);
  window->swap();
  window->poll();
  EXPECT_FALSE(window->isKeyDown(Key::Escape));
  EXPECT_FALSE(window->shouldClose());
  window->requestClose();
  EXPECT_TRUE(window->shouldClose());
  EXPECT_TRUE(context->takeGlErrors().empty());
  const auto headless = Context::createHeadless(); // both kinds side by side
  context->makeCurrent();
  EXPECT_TRUE(context->takeGlErrors().empty());
}

} // namespace
} // namespace brickfield::test
